"""Tests that a run fetches only the packages that the page needs, and runs none of their install scripts."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

LIVE = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "live"
NPM = """#!/bin/sh
echo "$@" >>"{asked}"
mkdir -p node_modules/.bin
touch node_modules/.package-lock.json
case "$*" in *--omit=dev*) ;; *) mkdir -p node_modules/puppeteer-core node_modules/axe-core ;; esac
printf '#!/bin/sh\\nmkdir -p dist; touch dist/main.js\\n' >node_modules/.bin/esbuild
printf '#!/bin/sh\\n' >node_modules/.bin/tsc
chmod +x node_modules/.bin/*
"""


class Bundle(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.asked = self.folder / "asked"
        (self.folder / "live").mkdir()
        shutil.copy(LIVE / "bundle", self.folder / "live")
        for name in ("prologue.sh", "removed_variables.txt"):
            shutil.copy(LIVE.parent / name, self.folder)
        shutil.copytree(LIVE / "page", self.folder / "live" / "page", ignore=shutil.ignore_patterns("node_modules", "dist", ".lock"))
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "npm").write_text(NPM.format(asked=self.asked), encoding="utf-8")
        (self.folder / "bin" / "npm").chmod(0o755)

    def bundle(self, *words, **environment):
        """The commands that npm got."""
        self.asked.write_text("", encoding="utf-8")
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        subprocess.run([self.folder / "live" / "bundle", *words], env={**os.environ, "PATH": path, **environment}, check=True, capture_output=True)
        return self.asked.read_text(encoding="utf-8").splitlines()

    def test_a_run_fetches_no_packages_of_tests_and_no_package_runs_a_script(self):
        (asked,) = self.bundle()
        self.assertLessEqual({"ci", "--omit=dev", "--ignore-scripts"}, set(asked.split()))
        self.assertEqual([], self.bundle())  # complete
        (asked,) = self.bundle("--for-tests")
        self.assertIn("--ignore-scripts", asked)
        self.assertNotIn("--omit=dev", asked)
        self.assertEqual([], self.bundle("--for-tests"))

    def test_the_page_needs_no_package_of_its_tests(self):
        lock = json.loads((LIVE / "page" / "package-lock.json").read_text(encoding="utf-8"))["packages"]
        needed = {name for name, entry in lock.items() if name and not entry.get("dev")}
        self.assertEqual(set(), {name for name in needed if not name.startswith(("node_modules/esbuild", "node_modules/@esbuild/", "node_modules/typescript",
                                                                                "node_modules/uplot"))})
        self.assertTrue(all(entry.get("integrity") for name, entry in lock.items() if name))

    def test_folders_of_cdpath_are_not_entered(self):
        (self.folder / "trap" / "live" / "page").mkdir(parents=True)
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        subprocess.run(["live/bundle"], env={**os.environ, "PATH": path, "CDPATH": str(self.folder / "trap")}, check=True, capture_output=True)
        self.assertTrue((self.folder / "live" / "page" / "dist" / "main.js").exists())
        self.assertEqual([], list((self.folder / "trap" / "live" / "page").iterdir()))


if __name__ == "__main__":
    unittest.main()
