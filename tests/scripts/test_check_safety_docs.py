"""Tests of check_safety_docs.py: it finds each inserted offence, and none in a sound tree."""
import os
import tempfile
import unittest

import check_safety_docs

SAFETY = """# Safety case

## Force
- Limit: `haptic_node.force_limit` (8 N).
- Tests: "The force obeys its limits", `tests/haptic_node`,
  "A title in two parts".

## Light
- Limit: none.
"""
SECURITY = """# Threats
| attack | test |
|---|---|
| links | `test_links` |
| forged forces | "The driver limits" |
A text with "a quotation" names no test.
"""
CPP = 'TEST_CASE("The force obeys its limits") {}\nTEST_CASE(\n    "A title "\n    "in two parts") {}\n'


class Checker(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name
        self.write("docs/safety.md", SAFETY)
        self.write("docs/security.md", SECURITY)
        self.write("tests/haptic_node/safety_test.cpp", CPP)
        self.write("tests/scripts/CMakeLists.txt", 'add_test(NAME "The driver limits" COMMAND true)\n')
        self.write("tests/python/test_archive.py", "class Links:\n    def test_links(self):\n        pass\n")
        self.write("haptic_node/settings.csv", "name,unit,default\nforce_limit,N,8\n")

    def write(self, path, text):
        path = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def check(self, *parts):
        found = check_safety_docs.offences(self.root)
        self.assertEqual(len(parts), len(found), found)
        for part, offence in zip(parts, found):
            self.assertIn(part, offence)

    def test_a_sound_tree_is_clean(self):
        self.check()

    def test_a_missing_security_page_has_nothing_to_check(self):
        os.remove(os.path.join(self.root, "docs/security.md"))
        self.check()

    def test_a_missing_safety_page_is_an_offence(self):
        os.remove(os.path.join(self.root, "docs/safety.md"))
        self.check("docs/safety.md:1: is missing")

    def test_a_renamed_test_is_found(self):
        self.write("tests/haptic_node/safety_test.cpp", CPP.replace("obeys", "observes"))
        self.check('docs/safety.md:5: there is no test "The force obeys its limits"')

    def test_a_renamed_test_on_a_continued_line_is_found(self):
        self.write("tests/haptic_node/safety_test.cpp", CPP.replace("in two", "in three"))
        self.check('docs/safety.md:6: there is no test "A title in two parts"')

    def test_a_missing_test_in_a_table_is_found(self):
        self.write("tests/python/test_archive.py", "")
        self.write("tests/scripts/CMakeLists.txt", "")
        self.check("docs/security.md:4: there is no test test_links", 'docs/security.md:5: there is no test "The driver limits"')

    def test_a_missing_path_is_found(self):
        self.write("docs/safety.md", SAFETY.replace("`tests/haptic_node`", "`tests/haptic`"))
        self.check("docs/safety.md:5: there is no tests/haptic")

    def test_a_limit_that_differs_from_its_setting_is_found(self):
        self.write("haptic_node/settings.csv", "name,unit,default\nforce_limit,N,9\n")
        self.check("haptic_node.force_limit is 9 N by default, not 8 N")
        self.write("haptic_node/settings.csv", "name,unit,default\n")
        self.check("there is no setting haptic_node.force_limit")

    def test_a_hazard_without_a_test_is_found(self):
        self.write("docs/safety.md", SAFETY.replace("Limit: none", "Limit: three flashes a second"))
        self.check("Light names no test")


if __name__ == "__main__":
    unittest.main()
