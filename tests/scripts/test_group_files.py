"""Tests of group_files.py: groups grow to their largest size, and no group holds two files with a name that the compiler would confuse."""
import unittest

import group_files
from group_files import LARGEST, Names, joined

TIMES = '#include "tests/times.h"\n'  # declares kMs and at_ms in tactus::test


def grouped(*sources):
    """Groups of sources in groups of one, as lists of their numbers."""
    names = {i: Names(source) for i, source in enumerate(sources)}
    return sorted(joined({f"g{i}": [i] for i in names}, names).values())


class Groups(unittest.TestCase):
    def test_files_without_common_names_share_groups_of_the_largest_size(self):
        groups = grouped(*(f"namespace {{ int f{i}(); }}" for i in range(2 * LARGEST + 3)))
        self.assertEqual([len(g) for g in groups], [LARGEST, LARGEST, 3])

    def test_files_that_declare_one_name_are_apart(self):
        for one, other in (("namespace { int kA = 1; }", "namespace { int kA = 2; }"), ("namespace { struct A {}; }", "namespace { enum { A }; }"),
                           ("#define A 1\n", "#define A 2\n"), ("using A = int;", "using A = long;"), ("namespace { enum { kOne, kTwo = 7 }; }", "namespace { int kTwo = 1; }")):
            with self.subTest(one):
                self.assertEqual(grouped(one, other), [[0], [1]])

    def test_equal_aliases_and_names_of_one_thing_are_together(self):
        for one, other in (("using A = int;", "using A = int;"), ("using tactus::sync::HostTime;", "using sync::HostTime;")):
            with self.subTest(one):
                self.assertEqual(grouped(one, other), [[0, 1]])

    def test_a_name_is_not_beside_a_header_that_declares_it(self):
        self.assertEqual(grouped("namespace { int kMs = 1; }", TIMES), [[0], [1]])
        self.assertEqual(grouped(TIMES + "namespace { int kMs = 1; }", TIMES), [[0], [1]])
        self.assertEqual(grouped("namespace { int kHour = 1; }", TIMES), [[0, 1]])

    def test_the_definition_of_a_function_is_beside_a_header_that_declares_it(self):
        self.assertEqual(grouped(TIMES + "sync::HostTime at_ms(std::int64_t t) { return {}; }", TIMES), [[0, 1]])

    def test_headers_include_others(self):
        self.assertIn("HostTime", group_files.names_of_headers(TIMES))

    def test_a_group_whose_files_clash_is_split(self):
        names = {0: Names("namespace { int kA = 1; }"), 1: Names("namespace { int kB = 1; }"), 2: Names("namespace { int kA = 2; }")}
        self.assertEqual(sorted(joined({"g": [0, 1, 2]}, names).values()), [[0, 1], [2]])

    def test_a_group_keeps_its_name(self):
        names = {i: Names(f"namespace {{ int f{i}(); }}") for i in range(3)}
        self.assertEqual(joined({"a": [0, 1], "b": [2]}, names), {"a": [0, 1, 2]})


if __name__ == "__main__":
    unittest.main()
