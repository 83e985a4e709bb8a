"""Tests of check_headers.py: a header that lacks an include is found, and only headers that nothing shows are compiled."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).with_name("check_headers.py")


class Headers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "compile_commands.json").write_text(json.dumps([{"command": f"c++ -I{self.root} -c shown.cpp", "file": "shown.cpp"}]))

    def write(self, name, text):
        (self.root / name).write_text(text)

    def check(self, *arguments):
        return subprocess.run([sys.executable, "-I", str(CHECK), "--build", str(self.root), "--root", str(self.root), *arguments],
                              capture_output=True, text=True, check=False)

    def test_a_header_that_needs_another_before_it_is_named(self):
        self.write("good.h", "#pragma once\nstruct Good {};\n")
        self.write("lucky.h", "#pragma once\ninline Good lucky() { return {}; }\n")
        self.write("lucky.cpp", '#include "good.h"\n#include "lucky.h"\n')
        result = self.check()
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("lucky.h does not compile alone", result.stdout)
        self.assertIn("1 of 1", result.stdout)

    def test_a_header_that_a_source_includes_first_is_left_to_the_compiler(self):
        self.write("shown.h", "#pragma once\nint shown();\n")
        self.write("shown.cpp", '#include "shown.h"\n')
        self.assertIn("0 of 0", self.check().stdout)
        self.assertIn("0 of 1", self.check("--all").stdout)

    def test_a_system_header_before_the_own_one_shows_nothing(self):
        self.write("late.h", "#pragma once\ninline std::size_t late() { return 0; }\n")
        self.write("late.cpp", '#include <cstddef>\n#include "late.h"\n')
        self.assertIn("late.h does not compile alone", self.check().stdout)


if __name__ == "__main__":
    unittest.main()
