#!/usr/bin/python3 -I
"""Checks that docs/settings.md is what cmake/generate_settings.py makes of every settings.csv.

  check_settings_doc.py ROOT            exits 1 and says what to do when it is not
  check_settings_doc.py ROOT --write    writes it
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import difflib
import glob
import subprocess
import tempfile


def generate(root, out):
    tables = sorted(glob.glob(os.path.join(root, "*", "settings.csv")))
    subprocess.run([sys.executable, os.path.join(root, "cmake", "generate_settings.py"), "markdown", out, *tables], check=True)


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if sys.argv[1:] else 1
    root = os.path.abspath(sys.argv[1])
    document = os.path.join(root, "docs", "settings.md")
    if "--write" in sys.argv:
        generate(root, document)
        return 0
    with tempfile.TemporaryDirectory() as folder:
        fresh = os.path.join(folder, "settings.md")
        generate(root, fresh)
        with open(fresh, encoding="utf-8") as file:
            wanted = file.read().splitlines()
    found = []
    if os.path.exists(document):
        with open(document, encoding="utf-8") as file:
            found = file.read().splitlines()
    if found == wanted:
        return 0
    print("docs/settings.md is out of date; run: cmake --build build/dev --target settings_doc")
    print("\n".join(list(difflib.unified_diff(found, wanted, "docs/settings.md", "generated", lineterm="", n=0))[:40]))
    return 1


if __name__ == "__main__":
    sys.exit(main())
