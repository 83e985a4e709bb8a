"""Tests of tests/portability without a chroot: mirrors, package sources, copies of a checkout, totals."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import checkout
import machine
import targets
import totals

LISTS = """http://mirror.example/debian/ Debian bookworm
http://other.example/node Node nodistro
http://mirror.example/debian/ Debian bookworm-updates
http://mirror.example/security/ Debian bookworm-security
"""
CTEST = """1/4 Test #1: sync: a clock   Passed
75% tests passed, 1 tests failed out of 4

The following tests did not run:
\t  3 - cluster: a screen (Skipped)

The following tests FAILED:
\t  2 - sync: a map, of two clocks (Failed)                unit
Errors while running CTest
100% tests passed, 0 tests failed out of 10
"""
AGAIN = """test: the failed tests run again, alone
100% tests passed, 0 tests failed out of 1
"""


class Machine(unittest.TestCase):
    def test_the_mirrors_are_those_of_this_machine(self):
        self.assertEqual(("http://mirror.example/debian", "http://mirror.example/security"), machine.mirrors(LISTS))
        self.assertEqual(("http://mirror.example/debian", None), machine.mirrors(LISTS.splitlines()[0]))

    def test_a_machine_without_package_lists_is_refused_with_a_remedy(self):
        for lists in ("", "\n", LISTS.splitlines()[1]):
            with self.assertRaisesRegex(machine.Refusal, "--mirror"):
                machine.mirrors(lists)

    def test_the_sources_name_the_release_its_updates_and_its_security_updates(self):
        text = machine.sources("trixie", "http://a.example/debian", "http://a.example/security")
        self.assertIn("URIs: http://a.example/debian\nSuites: trixie trixie-updates\n", text)
        self.assertIn("URIs: http://a.example/security\nSuites: trixie-security\n", text)
        self.assertNotIn("security", machine.sources("trixie", "http://a.example/debian", None))

    def test_of_the_settings_of_apt_only_proxies_and_checks_of_dates_are_taken(self):
        dump = 'Acquire::http::Proxy "http://proxy.example:3142";\nAcquire::Check-Date "false";\nAPT::Install-Recommends "1";\nAcquire::http "";\nDPkg::Post-Invoke:: "rm x";\n'
        self.assertEqual('Acquire::http::Proxy "http://proxy.example:3142";\nAcquire::Check-Date "false";\n', machine.apt_settings(dump))

    def test_no_file_of_the_folder_names_a_mirror(self):
        for path in HERE.iterdir():
            if path.is_file() and path != pathlib.Path(__file__).resolve():
                self.assertNotRegex(path.read_text(encoding="utf-8"), r"https?://", path)


class Checkout(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.source, self.target = pathlib.Path(kept.name, "source"), pathlib.Path(kept.name, "target")
        self.source.mkdir()
        subprocess.run(["git", "init", "-q", str(self.source)], check=True)
        for name, text in ((".gitignore", "build\n"), ("a.txt", "a"), ("folder/b name.txt", "b"), ("build/x.o", "x")):
            self.write(name, text)
        subprocess.run(["git", "-C", str(self.source), "add", "-A"], check=True)
        (self.source / "link").symlink_to("a.txt")  # new, and not ignored

    def write(self, name, text):
        path = self.source / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def names(self):
        return sorted(str(path.relative_to(self.target)) for path in self.target.rglob("*") if path.is_symlink() or path.is_file())

    def test_tracked_and_new_files_are_copied_and_ignored_ones_are_not(self):
        self.assertEqual(4, checkout.copy(self.source, self.target))
        self.assertEqual([".copied", ".gitignore", "a.txt", "folder/b name.txt", "link"], self.names())
        self.assertEqual("a.txt", os.readlink(self.target / "link"))

    def test_a_second_copy_takes_changes_only_and_keeps_times_and_results_of_the_build(self):
        checkout.copy(self.source, self.target)
        self.assertEqual((self.source / "a.txt").stat().st_mtime_ns, (self.target / "a.txt").stat().st_mtime_ns)
        (self.target / "build").mkdir()
        (self.target / "build/kept.o").write_text("kept", encoding="utf-8")
        self.assertEqual(0, checkout.copy(self.source, self.target))
        self.write("folder/b name.txt", "longer")
        (self.source / "a.txt").unlink()
        self.assertEqual(1, checkout.copy(self.source, self.target))
        self.assertEqual([".copied", ".gitignore", "build/kept.o", "folder/b name.txt", "link"], self.names())


class Totals(unittest.TestCase):
    def test_all_runs_of_ctest_are_added_and_failed_tests_are_named(self):
        found = totals.totals(CTEST)
        self.assertEqual({"passed": 12, "failed": 1, "skipped": 1, "names": ["sync: a map, of two clocks"]}, found)
        self.assertEqual("12 passed, 1 failed, 1 skipped", totals.sentence(found))

    def test_a_test_that_ran_again_counts_once(self):
        self.assertEqual(totals.totals(CTEST), totals.totals(CTEST + AGAIN))

    def test_a_text_without_tests_has_none(self):
        self.assertEqual({"passed": 0, "failed": 0, "skipped": 0, "names": []}, totals.totals("ninja: no work to do\n"))


class Targets(unittest.TestCase):
    def test_each_step_needs_packages_and_build_but_no_tests_before_it(self):
        trixie = targets.TARGETS["trixie"]
        self.assertEqual(["packages", "build", "run"], targets.steps_until(trixie, "run"))
        self.assertEqual(["packages"], targets.steps_until(trixie, "packages"))
        self.assertEqual(list(trixie.steps), targets.steps_until(trixie, None))
        self.assertEqual(["packages", "build", "unit"], targets.steps_until(targets.TARGETS["arm64"], "unit"))

    def test_arm64_takes_libraries_of_arm64_and_tools_of_this_machine(self):
        for name in targets.ARM64_PACKAGES:
            library = name.startswith("lib") and name not in ("libeigen3-dev", "libcli11-dev")
            self.assertEqual(library or name.startswith("catch2"), name.endswith(":arm64"), name)
        for test in targets.ARM64_TESTS:
            self.assertIn(test, targets.ARM64["build"])

    def test_arm64_has_no_run_of_a_scene(self):
        done = subprocess.run([HERE / "run", "arm64", "--only", "run"], capture_output=True, text=True, check=False)
        self.assertEqual(2, done.returncode)
        self.assertIn("packages, build, unit", done.stderr)


class Help(unittest.TestCase):
    def test_the_command_prints_its_help_and_refuses_an_unknown_release(self):
        done = subprocess.run([HERE / "run", "--help"], capture_output=True, text=True, check=True)
        self.assertIn("trixie", done.stdout)
        done = subprocess.run([HERE / "run", "potato"], capture_output=True, text=True, check=False)
        self.assertNotEqual(0, done.returncode)
        self.assertIn("potato", done.stderr)


if __name__ == "__main__":
    unittest.main()
