"""Tests that no Python program of the repository imports files of the user: of the current folder, of PYTHONPATH, of another Python."""
import ast
import concurrent.futures
import importlib.machinery
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.commands import dispatch, table
from tactus.paths import TACTUS

SHEBANG = "#!/usr/bin/python3 -I"
# examples: PYTHONPATH names the message types that the user generated for a driver.
SKIPPED = {"build", "node_modules", "out", "examples"}
TRAPS = ("json", "copy", "random", "statistics", "numpy", "tactus", "common", "pathlib", "subprocess", "argparse", "tempfile", "math", "struct", "csv")


def programs():
    """Executable files of the repository whose first line names Python."""
    found = []
    for folder, folders, names in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in SKIPPED and not name.startswith(".")]
        for path in (pathlib.Path(folder) / name for name in names):
            if os.access(path, os.X_OK) and path.is_file():
                with open(path, "rb") as file:
                    first = file.readline(200)
                if first.startswith(b"#!") and b"python" in first:
                    found.append(path)
    return found


class EveryProgram(unittest.TestCase):
    def test_every_program_starts_isolated_and_restarts_isolated_before_any_other_import(self):
        found = programs()
        self.assertGreater(len(found), 40)
        for path in found:
            with self.subTest(path.relative_to(ROOT)):
                text = path.read_text(encoding="utf-8")
                self.assertEqual(SHEBANG, text.partition("\n")[0])
                self.assertTrue(restarts_first(text), "imports modules before it is isolated")

    def test_a_program_that_imports_too_early_is_found(self):
        guard = "if __name__ == '__main__' and not sys.flags.isolated:\n    os.execv('x', [])\n"
        self.assertTrue(restarts_first(f'"""Text."""\nimport os\nimport sys\n{guard}import json\n'))
        self.assertFalse(restarts_first(f"import json\nimport os\nimport sys\n{guard}"))
        self.assertFalse(restarts_first("import os\nimport sys\n"))

    def test_no_program_imports_files_of_the_user(self):
        """Every command with --help, in a folder of traps that are also on PYTHONPATH, started directly and by another name of Python."""
        commands = [[str(TACTUS)], *([str(TACTUS), name] for name, c in table.BY_NAME.items() if "." in c.target),
                    *([str(path)] for path in programs() if path.parent == ROOT / "tests" / "measure")]
        with tempfile.TemporaryDirectory() as folder:
            for name in TRAPS:
                pathlib.Path(folder, f"{name}.py").write_text(f"open({folder + '/sprung'!r}, 'a').write('{name} ')\n", encoding="utf-8")
            environment = {**os.environ, "PYTHONPATH": folder, "PYTHONHOME": "/nonexistent", "PYTHONSTARTUP": f"{folder}/json.py"}

            def start(words):
                done = subprocess.run([*words, "--help"], cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=60)
                return words, done.returncode, done.stderr
            with concurrent.futures.ThreadPoolExecutor(2) as pool:
                answers = list(pool.map(start, commands))
            del environment["PYTHONPATH"], environment["PYTHONHOME"]  # Python itself would read them before any program
            answers += [start(["/usr/bin/python3", *words]) for words in commands[:2] + commands[-1:]]
            sprung = pathlib.Path(folder, "sprung")
            self.assertEqual("", sprung.read_text(encoding="utf-8") if sprung.exists() else "")
            self.assertEqual([], [answer for answer in answers if answer[1] != 0])


    def test_figures_ignore_the_settings_file_of_the_current_folder(self):
        program = f"import sys; sys.path.insert(0, {str(ROOT / 'scripts' / 'python')!r}); from tactus.report import figures; print(figures.matplotlib.rcParams['figure.facecolor'])"
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "matplotlibrc").write_text("figure.facecolor: red\n", encoding="utf-8")
            done = subprocess.run(["/usr/bin/python3", "-I", "-c", program], cwd=folder, capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual(("white\n", ""), (done.stdout, done.stderr))


def restarts_first(text):
    """True when a program imports only os and sys before it restarts in isolated mode."""
    for statement in ast.parse(text).body:
        if isinstance(statement, ast.If) and "sys.flags.isolated" in ast.unparse(statement.test):
            return True
        names = {alias.name for alias in statement.names} if isinstance(statement, ast.Import) else set()
        if isinstance(statement, ast.ImportFrom) or not names <= {"os", "sys"} or not isinstance(statement, (ast.Import, ast.Expr, ast.Assign)):
            return False
    return False


class Entry(unittest.TestCase):
    def entry(self):
        loader = importlib.machinery.SourceFileLoader("tactus_entry", str(TACTUS))
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader("tactus_entry", loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)
        return module

    def test_a_missing_module_is_named_with_the_python_that_lacks_it(self):
        with mock.patch.object(dispatch, "main", side_effect=ModuleNotFoundError("No module named 'lxml'", name="lxml.etree")):
            said = self.entry().main(["cluster"])
        self.assertIn("has no module lxml.etree; run scripts/setup cluster, which installs it", said)
        self.assertIn(sys.executable, said)

    def test_a_missing_module_of_the_package_is_a_defect_and_not_hidden(self):
        with mock.patch.object(dispatch, "main", side_effect=ModuleNotFoundError("", name="tactus.none")):
            self.assertRaises(ModuleNotFoundError, self.entry().main, ["run"])

    def test_only_modules_of_the_package_can_be_run_by_name(self):
        for words in ([], ["antigravity"], ["os.path"]):
            done = subprocess.run([TACTUS, "--module", *words], capture_output=True, text=True, check=False)
            self.assertEqual((1, 1), (done.returncode, done.stderr.count("\n")), done.stderr)


if __name__ == "__main__":
    unittest.main()
