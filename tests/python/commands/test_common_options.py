"""Tests of every command by the table of commands: help, examples, common options, exit status; and of the pages that are made from the help."""
import concurrent.futures
import gzip
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.commands import common_options
from tactus.commands.table import ALIASES, BY_NAME

TACTUS = str(ROOT / "scripts" / "tactus")
ENVIRONMENT = {**os.environ, "TACTUS_BIN": "/nowhere", "COLUMNS": "200"}


def tactus(*words, **how):
    return subprocess.run([TACTUS, *words], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, env=ENVIRONMENT, **how)


class EveryCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            cls.helps = dict(zip(BY_NAME, pool.map(lambda name: tactus(name, "--help"), BY_NAME)))

    def test_the_wanted_commands_exist(self):
        wanted = ("run replay record rerender rerun report export spy doctor study sweep cluster live degrade playout set simulate convert analyse-modes log setup").split()
        self.assertEqual([], [name for name in wanted if name not in BY_NAME])

    def test_help_names_the_command_and_ends_with_examples_and_the_exit_status(self):
        for name, command in BY_NAME.items():
            with self.subTest(name):
                done = self.helps[name]
                self.assertEqual((0, ""), (done.returncode, done.stderr))
                self.assertIn(name, done.stdout.split("\n\n")[0] + done.stdout.split("\n\n")[1])
                self.assertIn("Exit status", done.stdout)
                shown = done.stdout.partition("\nExamples\n")[2]
                for example, _ in command.examples:
                    self.assertIn(f"  tactus {example}\n", shown)

    def test_every_option_of_an_example_is_in_the_help(self):
        for name, command in BY_NAME.items():
            for example, _ in command.examples:
                words = example.split()
                owner = next(word for word in words if word in BY_NAME and (word != "attach" or "tactus" not in words)) if "tactus" not in words else words[words.index("tactus") + 1]
                if owner != name:
                    continue
                text = self.helps[name].stdout.partition("\nExamples\n")[0]
                text += "".join(tactus(name, verb, "--help").stdout for verb in command.verbs if verb in words and "describes a verb" in text)
                for option in (word for word in words if word.startswith("--")):
                    with self.subTest((name, option)):
                        self.assertIn(option, text)

    def test_a_file_of_json_that_cannot_be_written_is_refused_by_every_command_before_its_work(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder, "run.lcmlog")
            log.write_bytes(b"a log")
            for name, command in BY_NAME.items():
                if "json" not in command.options:
                    continue
                for words in (("--json", "/proc/none/a.json"), (f"--json={folder}",), (str(log), "--json", str(log))):
                    with self.subTest((name, words)):
                        done = tactus(name, *command.verbs[:1], *words)
                        self.assertEqual((1, ""), (done.returncode, done.stdout))
                        self.assertRegex(done.stderr, rf"^{name}: --json .*: .*; name .*\n$")
            self.assertEqual(b"a log", log.read_bytes())

    def test_the_common_options_of_the_table_are_those_of_the_help(self):
        for name, command in BY_NAME.items():
            text = self.helps[name].stdout.partition("\nOptions of every command\n")[0]
            if "describes a verb" in text:
                text = "".join(tactus(name, verb, "--help").stdout.partition("\nOptions of every command\n")[0] for verb in command.verbs)
            if command.passes_words or not text:
                continue
            has = {option for option in ("out", "json", "seed") if re.search(rf"(?m)(^\s*|[\[,] ?|\s)--{option}\b", text)}
            with self.subTest(name):
                self.assertEqual(set(command.options), has)

    def test_an_unknown_option_ends_with_1_and_one_sentence(self):
        for name, command in BY_NAME.items():
            if command.passes_words or name in ("spy", "simulate", "set", "playout"):  # refused by the program itself, inside a cluster
                continue
            verb = [command.verbs[0]] if command.verbs else []
            with self.subTest(name):
                done = tactus(name, *verb, "--no-such-option")
                self.assertEqual((1, "", 1), (done.returncode, done.stdout, done.stderr.count("\n")), done.stderr)

    def test_names_of_earlier_releases_still_work(self):
        for old, new in ALIASES.items():
            self.assertEqual(self.helps[new].stdout, tactus(old, "--help").stdout)


class Options(unittest.TestCase):
    def test_quiet_prints_nothing_but_errors(self):
        done = tactus("cluster", "check", "one_machine", "--quiet")
        self.assertEqual((0, "", ""), (done.returncode, done.stdout, done.stderr))
        done = tactus("export", "none", "--quiet")
        self.assertEqual((1, ""), (done.returncode, done.stdout))
        self.assertIn("cannot read none", done.stderr)

    def test_json_to_a_minus_prints_only_the_results(self):
        with tempfile.TemporaryDirectory() as folder:
            for words in (["--json", "-"], ["--json=-"]):
                done = tactus("doctor", "--seconds", "0.1", *words, cwd=folder)
                self.assertIn(done.returncode, (0, 1))
                self.assertIsInstance(json.loads(done.stdout), dict)
                self.assertIn("disk", done.stderr)
            alone = tactus("doctor", "--seconds", "0.1", "--json", "-", "--quiet", cwd=folder)
            self.assertEqual(json.loads(done.stdout).keys(), json.loads(alone.stdout).keys())
            self.assertEqual("", alone.stderr)

    def test_words_of_a_command_of_the_user_are_not_touched(self):
        for name in ("attach", "lab"):
            words = ["program", "--quiet", "--json", "-"]
            self.assertEqual(words, common_options.carried_out(BY_NAME[name], words))


class Pages(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        subprocess.run([str(ROOT / "cmake" / "generate_command_pages.py"), str(self.folder), "--version", "1.2.3"], check=True)

    def test_every_command_of_an_installation_has_a_page_and_completions(self):
        commands = [c for c in BY_NAME.values() if not c.from_source]
        self.assertEqual({"tactus.1.gz", *(f"tactus-{c.name}.1.gz" for c in commands)}, {path.name for path in (self.folder / "man1").iterdir()})
        for c in commands:
            page = gzip.decompress((self.folder / "man1" / f"tactus-{c.name}.1.gz").read_bytes()).decode()
            for part in (".TH ", ".SH NAME", ".SH DESCRIPTION", ".SH EXAMPLES", ".SH EXIT STATUS", "Tactus 1.2.3"):
                self.assertIn(part, page, c.name)
            for name in ("tactus.bash", "_tactus", "tactus.fish"):
                self.assertIn(f"{c.name}", (self.folder / name).read_text(encoding="utf-8"))

    def complete(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tactus; printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-c", script, "x", str(self.folder / "tactus.bash"), *words], capture_output=True, text=True, check=True)
        return done.stdout.split()

    def test_bash_completes_commands_verbs_and_options(self):
        self.assertEqual(["record", "replay", "report", "rerender", "rerun"],
                         sorted(self.complete("tactus", "re"), key=["record", "replay", "report", "rerender", "rerun"].index))
        self.assertEqual(["check"], [word for word in self.complete("tactus", "study", "ch") if word == "check"])
        self.assertIn("--without", self.complete("tactus", "run", "--wi"))
        self.assertIn("--seed", self.complete("tactus", "study", "check", "--se"))
        self.assertEqual([], self.complete("tactus", "log", "--wi"))


if __name__ == "__main__":
    unittest.main()
