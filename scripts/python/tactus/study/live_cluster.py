"""The live cluster of a study: starts and ends scripts/run, with a results folder for each run."""
import os
import signal
import subprocess
import time

from tactus import own_files
from tactus.paths import tactus_command
from tactus.refusal import Refusal

LONGEST_S = 86400  # limit of scripts/run
START_TIMEOUT_S, END_TIMEOUT_S = 120, 30
NO_PAGE = "the live page does not start"  # message of launch/live.py


def die_with_parent():
    """For Popen: sends SIGTERM to the child when this process ends for any reason; the run then ends as by Ctrl-C, with all results."""
    import ctypes
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


class LiveCluster:
    def __init__(self, out, words):
        """words: arguments of scripts/run, except --out and --seconds."""
        self.out = out
        self.log = out.with_suffix(".log")
        with own_files.open_private(self.log) as said:  # the address of the live page with its token is in it
            self.process = subprocess.Popen([*tactus_command("run"), *words, "--seconds", str(LONGEST_S), "--out", str(out)],
                                            stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT, start_new_session=True,
                                            preexec_fn=die_with_parent)

    def last_output_line(self):
        lines = self.log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return lines[-1] if lines else "no message"

    def wait_until_it_runs(self):
        """Waits until a trial runner can join. Raises Refusal."""
        end = time.monotonic() + START_TIMEOUT_S
        while not (self.out / "cluster" / "address").exists():
            self.check()
            if time.monotonic() > end:
                raise Refusal(f"run: has not started within {START_TIMEOUT_S} s; see {self.log}")
            time.sleep(0.05)

    def check(self):
        """Raises Refusal if the cluster has ended."""
        if self.process.poll() is not None:
            raise Refusal(f"run: the cluster has ended ({self.last_output_line()}); see {self.log}")

    def page(self):
        """Address of the live page, which the run prints some time after its start; None if the page does not start. Raises Refusal."""
        end = time.monotonic() + START_TIMEOUT_S
        while True:
            for line in self.log.read_text(encoding="utf-8", errors="replace").rpartition("\n")[0].splitlines():  # complete lines
                if "http://" in line:
                    return "http://" + line.split("http://")[1].split()[0]
                if NO_PAGE in line:
                    return None
            self.check()
            if time.monotonic() > end:
                raise Refusal(f"run: has printed no address of the live page within {START_TIMEOUT_S} s; see {self.log}")
            time.sleep(0.05)

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
