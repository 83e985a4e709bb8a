"""The runners of a sweep start each chunk once, with its arguments unchanged: no name of a folder is parsed by a shell, as a pattern or as an option."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.sweep import runners

HOSTILE = ("a b", "a&b", "it's", 'a"b', "$(touch sprung)", "`touch sprung`", "a;touch sprung", "a\nb", "%a %j", "back\\slash", "-rf", "*", os.fsdecode(b"\xff\xfe"), "{}", "~")
RECORDER = """#!/usr/bin/python3 -I
import json, os, sys
with open({file!r}, "a") as out:
    out.write(json.dumps(sys.argv[1:]) + "\\n")
"""
# As sbatch does: reads the script from stdin, and runs it for each task in --chdir.
SBATCH = """#!/usr/bin/python3 -I
import json, os, subprocess, sys
options = dict(word.partition("=")[::2] for word in sys.argv[1:])
with open({file!r} + ".options", "w") as out:
    json.dump(options, out)
script = sys.stdin.buffer.read()
last = int(options["--array"].split("-")[1])
for task in range(last + 1):
    subprocess.run(["/bin/sh", "-c", script], cwd=options["--chdir"], env={{**os.environ, "SLURM_ARRAY_TASK_ID": str(task)}})
print("7")
"""


class Runners(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.record = self.top / "record"
        self.enterContext(mock.patch.object(runners, "JOB", [self.script("job", RECORDER)]))

    def script(self, name, text):
        path = self.top / name
        path.write_text(text.format(file=str(self.record)), encoding="utf-8")
        path.chmod(0o755)
        return str(path)

    def folder(self, name):
        path = self.top / name
        path.mkdir()
        return types.SimpleNamespace(path=path, study=types.SimpleNamespace(name="s"))

    def recorded(self):
        lines = self.record.read_text(encoding="utf-8").splitlines()
        self.record.unlink()
        return sorted(map(json.loads, lines))

    def wait(self, runner):
        while not runner.poll():
            time.sleep(0.01)
        runner.end()

    def no_trap_sprung(self):
        self.assertEqual([], [path for path in self.top.rglob("*") if path.name == "sprung"])

    def test_every_chunk_is_played_once_in_a_folder_of_any_name(self):
        for name in HOSTILE:
            with self.subTest(name):
                folder = self.folder(name)
                with mock.patch.dict(os.environ, {"PARALLEL": "--dry-run", "SHELL": "/bin/false"}):
                    self.wait(runners.Parallel(folder, [3, 1, 2], 2))
                self.assertEqual([[str(folder.path), str(n)] for n in (1, 2, 3)], self.recorded())
        self.no_trap_sprung()

    def test_every_job_keeps_to_one_processor_and_the_processors_are_shared_equally(self):
        job = self.script("asks", "#!/usr/bin/python3 -I\nimport os, sys\nwith open({file!r}, 'a') as out:\n    out.write(str(sorted(os.sched_getaffinity(0))) + '\\n')\nsys.stdin.read()\n")
        allowed = sorted(os.sched_getaffinity(0))
        with mock.patch.object(runners, "JOB", [job]):
            runner = runners.Parallel(self.folder("out"), range(2 * len(allowed)), 2 * len(allowed))
            runner.fill()
            places = sorted(runner.place.values())
            self.wait(runner)
        self.assertEqual(sorted(2 * allowed), places)
        self.assertEqual(sorted([processor] for processor in 2 * allowed), self.recorded())
        self.assertEqual(len(allowed), runner.workers)

    def test_a_job_of_a_cluster_gets_the_folder_unchanged(self):
        for program, text in (("sbatch", SBATCH), ("squeue", "#!/bin/sh\necho COMPLETED\n"), ("scancel", "#!/bin/sh\n")):
            self.script(program, text)
        for name in HOSTILE:
            with self.subTest(name), mock.patch.dict(os.environ, {"PATH": f"{self.top}:{os.environ['PATH']}"}):
                folder = self.folder(name)
                self.wait(runners.Slurm(folder, [3, 1, 2], "", 64))
                self.assertEqual([[str(folder.path), "--of-array", str(folder.path / "array.txt")]] * 3, self.recorded())
                options = json.loads(pathlib.Path(f"{self.record}.options").read_text(encoding="utf-8"))
                self.assertEqual((str(folder.path), "slurm-%a.txt"), (options["--chdir"], options["--output"]))
        self.no_trap_sprung()

    def test_a_failed_job_is_reported_with_its_last_line_and_stops_no_other(self):
        job = self.script("fails", '#!/bin/sh\necho "$2" >>"$1/played"\n[ "$2" != 2 ] || {{ echo "no scene" >&2; exit 1; }}\n')
        with mock.patch.object(runners, "JOB", [job]):
            folder = self.folder("out")
            runner = runners.Parallel(folder, [1, 2, 3], 1)
            self.wait(runner)
        self.assertEqual("no scene", runner.said())
        self.assertEqual("1\n2\n3\n", (folder.path / "played").read_text(encoding="utf-8"))

    def test_the_end_of_a_sweep_ends_its_jobs_and_starts_no_other(self):
        job = self.script("sleeps", '#!/bin/sh\nsleep 100\n')
        with mock.patch.object(runners, "JOB", [job]):
            runner = runners.Parallel(self.folder("out"), [1, 2, 3], 2)
            self.assertFalse(runner.poll())
            runner.end()
        self.assertEqual([True, True], [job.returncode is not None for job in runner.running])
        self.assertEqual([], runner.waiting)

    def test_an_interrupt_while_a_job_starts_leaves_no_unknown_process(self):
        job = self.script("sleeps", '#!/bin/sh\nsleep 100\n')
        started, popen = [], subprocess.Popen

        def interrupted(*words, **options):
            started.append(popen(*words, **options))
            os.kill(os.getpid(), signal.SIGINT)
            return started[-1]
        with mock.patch.object(runners, "JOB", [job]), mock.patch.object(runners.subprocess, "Popen", interrupted):
            runner = runners.Parallel(self.folder("out"), [1, 2], 2)
            self.assertRaises(KeyboardInterrupt, runner.poll)
            runner.end()
        self.assertEqual([True], [process.poll() is not None for process in started])


if __name__ == "__main__":
    unittest.main()
