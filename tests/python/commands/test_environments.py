"""Tests that every command answers in every environment of the table as in a plain one, and executes no file of the user."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
import environments
from tactus import environment
from tactus.launch import network, results


class Table(unittest.TestCase):
    def test_every_command_answers_in_every_environment_as_in_a_plain_one(self):
        with tempfile.TemporaryDirectory() as folder:
            verdicts = environments.table(pathlib.Path(folder), helps_every=7)  # tests/measure/environment_table: all of them
        self.assertEqual({}, {(e, name): verdict for e, row in verdicts.items() for name, verdict in row.items() if not environments.is_right(verdict)})

    def test_every_variable_of_the_table_of_removed_ones_is_removed(self):
        names = [line.split()[0] for line in environment.TABLE.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
        given = {name.replace("*", "_X"): "1" for name in names}
        self.assertEqual(sorted(given), sorted(environment.removed([*given, "PATH", "TACTUS_BIN", "GITHUB"])))
        script = "source scripts/prologue.sh; compgen -e"
        said = subprocess.run(["/bin/bash", "-p", "-c", f'{{ {script}; }}', "x"], cwd=environments.ROOT, env={**os.environ, **given}, capture_output=True, text=True,
                              check=True).stdout.split()
        self.assertEqual([], [name for name in given if name in said])


class Streams(unittest.TestCase):
    def shell(self, words):
        return subprocess.run(["sh", "-c", words, str(environments.SCRIPTS / "tactus")], capture_output=True, text=True, check=False,
                              env={**os.environ, "TACTUS_BIN": "/nowhere"})

    def test_a_full_output_is_one_sentence(self):
        done = self.shell('"$0" --help >/dev/full')
        self.assertEqual((1, "tactus: No space left on device\n"), (done.returncode, done.stderr))

    def test_a_closed_output_gets_no_file_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.shell(f'"$0" private-path make --hosts a,b --server 192.0.2.7 --out {folder}/keys >&- 2>&-')
            self.assertEqual((0, "", ""), (done.returncode, done.stdout, done.stderr))
            for path in pathlib.Path(folder).rglob("*"):
                self.assertFalse(path.is_file() and b"Copy to each" in path.read_bytes(), path)


class Provenance(unittest.TestCase):
    def git(self, folder, *words):
        kept = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
        return subprocess.run(["git", "-C", folder, "-c", "user.name=a", "-c", "user.email=a@b.example", *words], capture_output=True, text=True, check=True,
                              env=kept).stdout.strip()

    def commit(self, folder):
        self.git(folder, "init", "--quiet")
        self.git(folder, "commit", "--quiet", "--allow-empty", "-m", "first")
        return self.git(folder, "rev-parse", "HEAD")

    def test_the_recorded_commit_is_that_of_this_repository_and_of_no_other(self):
        with tempfile.TemporaryDirectory() as kept:
            outer = pathlib.Path(kept)
            inner, other = outer / "inner", outer / "other"
            inner.mkdir()
            other.mkdir()
            self.commit(outer)
            variables = {"GIT_DIR": str(other / ".git"), "GIT_WORK_TREE": str(other)}
            self.commit(other)
            with mock.patch.object(results, "REPOSITORY", inner), mock.patch.dict(os.environ, variables):
                self.assertEqual("unknown", results.git_commit())  # without a repository of its own, inside one of the user
                right = self.commit(inner)
                self.assertEqual(right, results.git_commit())


class Network(unittest.TestCase):
    """A private network is judged by its effect: output on stderr is no refusal."""

    def choose(self, unshare):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "unshare"
            program.write_text(f"#!/bin/sh\n{unshare}\n", encoding="utf-8")
            program.chmod(0o755)
            with mock.patch.object(network, "PATH", f"{folder}:{network.PATH}"), mock.patch.dict(os.environ, {"PATH": f"{folder}:{os.environ['PATH']}"}):
                return network.is_allowed(["unshare", "--net", "--mount-proc"], "true")

    def test_a_warning_of_the_dynamic_linker_is_no_refusal(self):
        self.assertTrue(self.choose('echo "ERROR: ld.so: object cannot be preloaded" >&2; shift 2; exec "$@"'))

    def test_a_refused_mount_is_a_refusal_whatever_the_status(self):
        self.assertFalse(self.choose("echo refused >&2; exit 0"))
        self.assertFalse(self.choose("echo refused >&2; exit 1"))

    def test_a_missing_program_is_named(self):
        with mock.patch.object(network, "PATH", "/none"):
            self.assertEqual("unshare is missing (package util-linux)", network.no_namespaces())


if __name__ == "__main__":
    unittest.main()
