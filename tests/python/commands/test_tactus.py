"""Tests of the command `tactus`: dispatch from any folder, help, nearest name of a misspelt command, refusals."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.commands.table import BY_NAME, GROUPS

TACTUS = ROOT / "scripts" / "tactus"


def tactus(*words, program=TACTUS, **how):
    return subprocess.run([program, *words], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, **how)


class Help(unittest.TestCase):
    def test_all_commands_are_listed_in_their_groups(self):
        done = tactus("--help")
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        for group, commands in GROUPS.items():
            listed = done.stdout.split(f"\n{group}\n")[1].split("\n\n")[0].splitlines()
            self.assertEqual([c.name for c in commands], [line.split()[0] for line in listed])
            for line in listed:
                self.assertLessEqual(len(line), 100)

    def test_every_command_has_help(self):
        for name in BY_NAME:
            with self.subTest(name):
                done = tactus(name, "--help", env={**os.environ, "TACTUS_BIN": "/nowhere"})
                self.assertEqual((0, ""), (done.returncode, done.stderr))
                self.assertGreater(len(done.stdout.split()), 12)
                self.assertIn(name, done.stdout)

    def test_without_arguments_all_commands_are_listed(self):
        done = tactus()
        self.assertEqual((1, ""), (done.returncode, done.stdout))
        self.assertIn("rerender", done.stderr)

    def test_a_misspelt_name_suggests_the_nearest(self):
        for wrong, right in (("reply", "replay"), ("private_path", "private-path"), ("degarde", "degrade")):
            done = tactus(wrong)
            self.assertEqual(1, done.returncode)
            self.assertEqual(f"tactus: there is no command '{wrong}'; did you mean '{right}'?\n", done.stderr)
        self.assertEqual("tactus: there is no command 'xyzzy'; tactus --help lists them\n", tactus("xyzzy").stderr)


class Anywhere(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_tactus_runs_through_a_link_on_the_path(self):
        (self.folder / "tactus").symlink_to(TACTUS)
        done = subprocess.run(["tactus", "build", "--help"], capture_output=True, text=True, check=False, cwd="/",
                              env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        self.assertIn("scripts/build", done.stdout)

    def test_no_module_is_imported_from_the_current_folder(self):
        for name in ("argparse", "tactus", "importlib", "numpy", "report"):
            (self.folder / f"{name}.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
        for environment in (os.environ, {**os.environ, "PYTHONPATH": str(self.folder)}):
            for words in (("--help",), ("report", "--help"), ("study", "check", "--help")):
                done = tactus(*words, cwd=self.folder, env={**environment, "TACTUS_BIN": "/nowhere"})
                self.assertEqual((0, ""), (done.returncode, done.stderr))

    def test_a_closed_output_is_no_error(self):
        done = subprocess.run(f"{TACTUS} --help | head -c 1", shell=True, capture_output=True, text=True, check=False)
        self.assertEqual(("U", ""), (done.stdout, done.stderr))


class Refusals(unittest.TestCase):
    def test_invalid_arguments_exit_with_1_and_one_sentence(self):
        for words, sentence in (
                (("degrade", "none.xml"), "degrade: the profile none.xml is not a file; give the path of an XML file, or off"),
                (("degrade", "--fast"), "degrade: unknown option '--fast'; see tactus degrade --help"),
                (("playout", "asap", "--in"), "playout: --in needs the folder that a run writes to; see tactus playout --help"),
                (("set", "haptic_node", "a=1", "--in", "/none"), "set: the folder /none does not exist; name the folder that a run writes to"),
                (("attach", "/tmp/"), "attach: name a command to run; see tactus attach --help"),
                (("export",), "export: name a log; see tactus export --help"),
                (("export", "none.lcmlog"), "export: cannot read none.lcmlog; give the run.lcmlog of a run, or its folder"),
                (("export", "--fast"), "export: there is no option --fast; see tactus export --help"),
                (("live", "close"), "live: there is no verb 'close'; choose from open, follow"),
                (("study", "find"), "study: there is no verb 'find'; choose from check, run, sweep, analyse, replicate, information, battery")):
            with self.subTest(words):
                done = tactus(*words, env={**os.environ, "TACTUS_BIN": "/nowhere"})
                self.assertEqual((1, "", sentence + "\n"), (done.returncode, done.stdout, done.stderr))

    def test_commands_without_a_running_cluster_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "TMPDIR": folder, "TACTUS_BIN": "/nowhere"}
            for words in (("attach", "true"), ("spy",), ("degrade", "off"), ("simulate", "pause")):
                done = tactus(*words, env=environment)
                self.assertEqual((1, "attach: no cluster is running; start one with tactus run, or name its output folder\n"), (done.returncode, done.stderr))
            done = tactus("attach", folder, "true", env=environment)
            self.assertEqual((1, f"attach: no cluster is running that writes to {folder}; start one with tactus run --out {folder}\n"), (done.returncode, done.stderr))


if __name__ == "__main__":
    unittest.main()
