"""Tests that no name of the user is parsed by a shell or breaks a command: folders, scenes, studies, hosts, participants, groups, with spaces, quotes,
substitutions, line ends, bytes that are not UTF-8, and 1,200 characters. Each command does its work or refuses the name with one sentence."""
import ast
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.commands.table import BY_NAME

TACTUS = str(ROOT / "scripts" / "tactus")
NAMES = ("a b", "a&touch sprung&b", "it's", 'a"b', "$(touch sprung)", "`touch sprung`", "a;touch sprung;", "a\ntouch sprung\n", "|touch sprung", "%s%n", "*", "~", "\\",
         os.fsdecode(b"\xff\xfe"), "/".join(["d" * 200] * 6))
# Words of every command with {} for the name: of an input, and of an output where it has one.
WORDS = {
    "run": (["run", "{}.sdf"], ["run", "--out", "{}"], ["run", "--degrade", "{}"], ["run", "--room", "{}"], ["run", "--set", "haptic_node.{}=1"], ["run", "--device", "{}"]),
    "replay": (["replay", "{}"], ["replay", "run.lcmlog", "--out", "{}"]),
    "live": (["live", "follow", "http://127.0.0.1:1/{}", "--seconds", "0.1"],),
    "doctor": (["doctor", "--out", "{}", "--seconds", "0.01"],),
    "attach": (["attach", "./{}", "true"], ["attach", "{}"]),
    "spy": (["spy", "{}"],),
    "degrade": (["degrade", "{}"], ["degrade", "off", "{}"]),
    "playout": (["playout", "asap", "--in", "{}"],),
    "record": (["record", "--out", "{}", "--in", "{}"], ["record", "--network", "--group", "{}"]),
    "simulate": (["simulate", "snapshot", "{}", "--in", "{}"],),
    "set": (["set", "{}", "{}={}", "--in", "{}"],),
    "disturb": (["disturb", "{}"],),
    "export": (["export", "{}"], ["export", "run.lcmlog", "--out", "{}"]),
    "report": (["report", "{}"], ["report", "run.lcmlog", "--out", "{}.html", "--name", "{}"]),
    "log": (["log", "upgrade", "{}", "{}.lcmlog"],),
    "metrics": (["metrics", "{}"], ["metrics", "run.lcmlog", "--reference", "{}", "--json", "{}"]),
    "rerender": (["rerender", "{}"], ["rerender", "run.lcmlog", "--out", "{}", "--degrade", "{}"]),
    "rerun": (["rerun", "{}"], ["rerun", "run.lcmlog", "--out", "{}", "--degrade", "{}"], ["rerun", "run.lcmlog", "--scene", "{}", "--tool", "{}"]),
    "study": (["study", "check", "{}"], ["study", "run", "{}", "--participant", "{}"], ["study", "sweep", "{}", "--games", "1", "--out", "{}"], ["study", "analyse", "{}"]),
    "sweep": (["sweep", "{}", "--games", "1", "--out", "{}"],),
    "cluster": (["cluster", "check", "{}"], ["cluster", "up", "--file", "{}"]),
    "lab": (["lab", "--hosts", "{}", "true"],),
    "private-path": (["private-path", "make", "--hosts", "{}", "--server", "192.0.2.7", "--out", "keys"], ["private-path", "make", "--hosts", "a,b", "--server", "{}", "--out", "keys"]),
    "units": (["units", "install", "--root", "{}"], ["units", "install", "--root", ".", "--host", "{}", "--units-only"]),
    "convert": (["convert", "{}.obj", "{}.glb"],),
    "analyse-modes": (["analyse-modes", "{}.wav", "--out", "{}.xml"],),
    "check-sounds": (["check-sounds", "{}", "--scene", "{}"],),
    "drumkit-sounds": (["drumkit-sounds", "{}", "--from", "{}"],),
    "setup": (["setup", "{}"],),
    "package": (["package", "--preset", "{}"],),
    "build": (["build", "--preset", "{}"],),
    "test": (["test", "--preset", "{}"], ["test", "--repeat", "{}"]),
}


class EveryCommand(unittest.TestCase):
    maxDiff = None

    def test_the_table_holds_every_command(self):
        self.assertEqual(set(BY_NAME), set(WORDS))

    def test_a_hostile_name_is_executed_by_no_command_and_gives_at_most_one_sentence(self):
        with tempfile.TemporaryDirectory() as kept:
            top = pathlib.Path(kept)
            environment = {**os.environ, "TACTUS_BIN": "/nowhere", "TMPDIR": str(top), "COLUMNS": "1000"}
            jobs = []
            for number, (words, name) in enumerate((words, name) for forms in WORDS.values() for words in forms for name in NAMES):
                folder = top / str(number)
                folder.mkdir()
                (folder / "run.lcmlog").write_bytes(b"")
                jobs.append((folder, [word.replace("{}", name) for word in words]))

            def start(job):
                folder, words = job
                return subprocess.run([TACTUS, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=120)
            with concurrent.futures.ThreadPoolExecutor(2) as pool:
                answers = list(pool.map(start, jobs))
            self.assertEqual([], [path for path in top.rglob("*sprung*") if path.name == "sprung"])
            wrong = []
            for (_, words), done in zip(jobs, answers):
                lines = [line for line in done.stderr.splitlines() if line.strip() and not line.startswith((b"usage:", b"Usage:"))]
                if done.returncode not in (0, 1, 2) or b"Traceback" in done.stderr or done.returncode != 0 and len(lines) != 1:
                    wrong.append((words, done.returncode, done.stderr[-400:]))
        self.assertEqual([], wrong, f"{len(wrong)} of {len(jobs)}")


class Sources(unittest.TestCase):
    # Their text is composed of constants of the module only; names follow as arguments of the shell.
    REVIEWED = {"launch/network.py": 1, "launch/privileges.py": 1, "cluster/lab.py": 1}

    def test_no_module_starts_a_shell_with_a_name_in_its_text(self):
        package = ROOT / "scripts" / "python" / "tactus"
        for path in sorted(package.rglob("*.py")):
            name, composed = str(path.relative_to(package)), 0
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call):
                    self.assertFalse(any(keyword.arg == "shell" for keyword in node.keywords), name)
                    self.assertNotIn(ast.unparse(node.func), ("os.system", "os.popen", "subprocess.getoutput", "subprocess.getstatusoutput"), name)
                if isinstance(node, ast.List) and {"sh", "bash"} & {e.value for e in node.elts if isinstance(e, ast.Constant)}:
                    composed += sum(isinstance(flag, ast.Constant) and flag.value == "-c" and not isinstance(text, (ast.Constant, ast.Attribute))
                                    for flag, text in zip(node.elts, node.elts[1:]))
            self.assertEqual(self.REVIEWED.get(name, 0), composed, name)


if __name__ == "__main__":
    unittest.main()
