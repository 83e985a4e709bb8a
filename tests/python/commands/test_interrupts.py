"""Tests of Ctrl-C: every command ends with 130 and one line, without a traceback, and leaves no folder; a signal that the caller ignores stays ignored."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import types
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus import signals
from tactus.cluster import deployment
from tactus.launch import main

TACTUS = str(ROOT / "scripts" / "tactus")
# A program of the build, or of the system, that does not end.
WAITS = '#!/bin/sh\n: >"$STARTED"\nexec sleep 100\n'
STUDY = f"""<?xml version="1.0" encoding="UTF-8"?>
<study name="s" version="1" scene="{ROOT}/sim_node/scenes/dark_room_game.sdf" task="game" seed="3">
  <conditions><nothing/><remove modality="audio"/></conditions><procedure kind="constant" repetitions="1"/><response kind="performance"/><stimulus by="participant" limit="1s"/>
</study>
"""
# {command: (words, program that does not end, last line)}. The folder holds run.lcmlog, sound.wav and study.xml.
CASES = {
    "run": (["run", "single_taps.sdf"], "sim_node", "run: interrupted; nothing was started"),
    "replay": (["replay", "run.lcmlog"], "replay", "replay: interrupted; nothing was started"),
    "report": (["report", "run.lcmlog", "--out", "page.html"], "summarise", "tactus report: interrupted"),
    "export": (["export", "run.lcmlog", "--out", "a/b/tables"], "export_log", "tactus export: interrupted"),
    "rerender": (["rerender", "run.lcmlog", "--only", "audio", "--out", "again"], "audio_node", "rerender: interrupted"),
    "rerun": (["rerun", "run.lcmlog", "--out", "again"], "replay", "rerun: interrupted"),
    "study check": (["study", "check", "study.xml"], "sync_node", "tactus study: interrupted"),
    "study sweep": (["study", "sweep", "study.xml", "--games", "1", "--out", "sweep"], "play_games",
                    "study sweep: interrupted; no finished game is lost; continue with --resume"),
    "analyse-modes": (["analyse-modes", "sound.wav", "--out", "m.xml", "--base", "copper"], "ffprobe", "tactus analyse-modes: interrupted"),
    "check-sounds": (["check-sounds", "."], "check_sounds", "tactus check-sounds: interrupted"),
    "cluster": (["cluster", "up", "one_machine"], "message_types", "tactus cluster: interrupted"),
    "setup": (["setup"], "dpkg-query", "setup: interrupted"),
    "doctor": (["doctor", "--seconds", "100"], None, "tactus doctor: interrupted"),
}
RESUMED = {"study sweep"}  # keeps its folder


class Interrupted(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.top = pathlib.Path(kept.name)

    def folder(self, name, program):
        """(current folder of the command, its environment)."""
        here, programs, temporary = (self.top / name / part for part in ("here", "bin", "tmp"))
        for path in (here, programs, temporary):
            path.mkdir(parents=True)
        (here / "run.lcmlog").write_bytes(b"\xed\xa1\xda\x01" + bytes(24))
        (here / "sound.wav").write_bytes(bytes(100))
        (here / "study.xml").write_text(STUDY, encoding="utf-8")
        for other in (*deployment.PROGRAMS, "summarise", "export_csv", "export_events", "export_log", "virtual_time", "play_games"):
            self.write(programs / other, "#!/bin/sh\necho '{}'\n")  # as the description of a log, for example
        if program:
            self.write(programs / program, WAITS)
        return here, {**os.environ, "TACTUS_BIN": str(programs), "PATH": f"{programs}:{os.environ['PATH']}", "STARTED": str(self.top / name / "started"), "TMPDIR": str(temporary)}

    def write(self, path, text):
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def test_every_command_ends_with_130_and_one_line_and_leaves_no_folder(self):
        for name, (words, program, last) in CASES.items():
            with self.subTest(name):
                here, environment = self.folder(name, program)
                before = sorted(here.rglob("*"))
                process = subprocess.Popen([TACTUS, *words], cwd=here, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                           text=True, start_new_session=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
                if program:
                    while not pathlib.Path(environment["STARTED"]).exists():
                        if process.poll() is not None:
                            self.fail(f"ended early: {process.communicate()}")
                        time.sleep(0.01)
                else:
                    process.stdout.readline()
                os.killpg(process.pid, signal.SIGINT)
                _, said = process.communicate(timeout=60)
                self.assertEqual((130, last), (process.returncode, said.strip().split("\n")[-1]), said)
                self.assertNotIn("Traceback", said)
                self.assertEqual(1, said.count("interrupted"), said)
                if name not in RESUMED:
                    self.assertEqual(before, sorted(here.rglob("*")))
                self.assertEqual([], list((self.top / name / "tmp").iterdir()))


class Ignored(unittest.TestCase):
    def setUp(self):
        for number in signals.ENDING:
            self.addCleanup(signal.signal, number, signal.getsignal(number))
            signal.signal(number, signal.SIG_DFL)

    def test_a_signal_that_the_caller_ignores_ends_nothing(self):
        signal.signal(signal.SIGHUP, signal.SIG_IGN)  # nohup
        stop = signals.Stop()
        os.kill(os.getpid(), signal.SIGHUP)
        self.assertFalse(stop.requested)
        self.assertIs(signal.SIG_IGN, signal.getsignal(signal.SIGHUP))
        os.kill(os.getpid(), signal.SIGTERM)
        self.assertEqual((True, "SIGTERM"), (stop.requested, stop.reason))

    def test_a_run_that_was_cut_short_names_the_signal_and_its_duration(self):
        stop = signals.Stop()
        now = [100.0]

        def sleep(seconds):
            now[0] += seconds
            if now[0] > 103.15:
                stop.request(signal.SIGHUP)
        running = types.SimpleNamespace(world_has_begun=lambda: True, expects_world=lambda: True, show_table=lambda: None, page=None, alive=lambda: True, lost=dict)
        with mock.patch.object(main.time, "monotonic", lambda: now[0]), mock.patch.object(main.time, "sleep", sleep):
            self.assertTrue(main.watch_over(running, 20, stop))
        self.assertEqual("ended by SIGHUP, because the terminal was closed after 3.1 of 20 s", stop.cut_short)

    def test_a_complete_run_was_not_cut_short(self):
        stop, now = signals.Stop(), [0.0]

        def sleep(seconds):
            now[0] += seconds
        running = types.SimpleNamespace(world_has_begun=lambda: True, expects_world=lambda: True, show_table=lambda: None, page=None, alive=lambda: True, lost=dict)
        with mock.patch.object(main.time, "monotonic", lambda: now[0]), mock.patch.object(main.time, "sleep", sleep):
            self.assertTrue(main.watch_over(running, 2, stop))
        self.assertEqual("", stop.cut_short)


if __name__ == "__main__":
    unittest.main()
