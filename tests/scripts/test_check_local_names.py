"""Tests of check_local_names.py: it finds a name in two files of a folder, and accepts overloads and equal aliases."""
import pathlib
import tempfile
import unittest

import check_local_names


class LocalNames(unittest.TestCase):
    def clashes(self, first, second):
        with tempfile.TemporaryDirectory() as folder:
            paths = [pathlib.Path(folder, name) for name in ("a.cpp", "b.cpp")]
            for path, text in zip(paths, (first, second)):
                path.write_text(text, encoding="utf-8")
            return [name for name, _ in check_local_names.clashes(paths)]

    def test_every_kind_of_local_name_is_found(self):
        for declaration, name in (("constexpr double kDt = 1e-3;", "kDt"), ("constexpr int kA = f(1, 2), kB{3};", "kB"), ("struct Rig { int at(int x) { return x; } };", "Rig"),
                                  ("double at(double x) { return x; }", "at"), ("template <class T> T twice(T x) { return 2 * x; }", "twice"),
                                  ("const std::array<int, 2> kPair{1, 2};", "kPair"), ("enum class Kind { kOne };", "Kind"),
                                  ("const char* const kText = \"};\" \"// text\";", "kText")):
            with self.subTest(declaration):
                self.assertIn(name, self.clashes(f"namespace tactus {{\nnamespace {{\n{declaration}\n}}\n}}\n", f"namespace tactus {{\nnamespace {{\n{declaration}\n}}\n}}\n"))

    def test_a_static_name_and_a_macro_are_local(self):
        self.assertEqual(self.clashes("static int count = 0;\n", "static int count = 1;\n"), ["count"])
        self.assertEqual(self.clashes("#define WIDTH 4\n", "#define WIDTH 8\n"), ["WIDTH"])
        self.assertEqual(self.clashes("#define WIDTH 4\n#undef WIDTH\n", "#define WIDTH 8\n#undef WIDTH\n"), [])

    def test_overloads_may_share_a_name_unless_one_call_fits_both(self):
        inside = "namespace {{ {} }}\n".format
        self.assertEqual(self.clashes(inside("int f(int x) { return x; }"), inside("int f(double y) { return 1; }")), [])
        self.assertEqual(self.clashes(inside("int f(int x) { return x; }"), inside("int f(int other, int more = 2) { return 1; }")), ["f"])

    def test_equal_aliases_may_repeat(self):
        self.assertEqual(self.clashes("using Eigen::Vector3d;\nnamespace fs = std::filesystem;\n", "using Eigen::Vector3d;\nnamespace fs = std::filesystem;\n"), [])
        self.assertEqual(self.clashes("namespace { using Bytes = A; }\n", "namespace { using Bytes = B; }\n"), ["Bytes"])

    def test_names_of_classes_namespaces_and_definitions_of_members_are_not_local(self):
        self.assertEqual(self.clashes("namespace a { namespace { int f() { return 1; } } }\n", "namespace b { namespace { int f() { return 1; } } }\n"), [])
        self.assertEqual(self.clashes("int A::f() { constexpr int kInside = 1; return kInside; }\n", "int B::f() { constexpr int kInside = 1; return kInside; }\n"), [])
        self.assertEqual(self.clashes("TEST_CASE(\"one\") { int x = 1; }\n", "TEST_CASE(\"two\") { int x = 1; }\n"), [])


if __name__ == "__main__":
    unittest.main()
