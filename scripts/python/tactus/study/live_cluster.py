"""The live cluster of a study: scripts/run, started and ended by the study, in a folder of its own for each time that it runs."""
import os
import signal
import subprocess
import time

from tactus.paths import SCRIPTS
from tactus.refusal import Refusal

LONGEST_S = 86400  # scripts/run's own bound
BEGINS_WITHIN_S, ENDS_WITHIN_S = 120, 30
NO_PAGE = "the live page does not start"  # what launch/live.py says


def die_with_parent():
    """For Popen: asked to end when this process is no more, whatever killed it; the run then ends as by Ctrl-C, with all results."""
    import ctypes
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


class LiveCluster:
    def __init__(self, out, words):
        """words: of scripts/run, but for where the results go and for how long."""
        self.out = out
        self.log = out.with_suffix(".log")
        with open(self.log, "w", encoding="utf-8") as said:
            self.process = subprocess.Popen([str(SCRIPTS / "run"), *words, "--seconds", str(LONGEST_S), "--out", str(out)],
                                            stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT, start_new_session=True,
                                            preexec_fn=die_with_parent)

    def last_words(self):
        lines = self.log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return lines[-1] if lines else "it said nothing"

    def wait_until_it_runs(self):
        """Until a conductor can join. Raises Refusal."""
        end = time.monotonic() + BEGINS_WITHIN_S
        while not (self.out / "cluster" / "address").exists():
            self.check()
            if time.monotonic() > end:
                raise Refusal(f"run: has not begun within {BEGINS_WITHIN_S} s; see {self.log}")
            time.sleep(0.05)

    def check(self):
        """Raises Refusal when it has ended."""
        if self.process.poll() is not None:
            raise Refusal(f"run: the cluster has ended ({self.last_words()}); see {self.log}")

    def page(self):
        """Address of the live page, which the run tells a while after it has begun; None when it says that there is none. Raises Refusal."""
        end = time.monotonic() + BEGINS_WITHIN_S
        while True:
            for line in self.log.read_text(encoding="utf-8", errors="replace").rpartition("\n")[0].splitlines():  # whole ones
                if "http://" in line:
                    return "http://" + line.split("http://")[1].split()[0]
                if NO_PAGE in line:
                    return None
            self.check()
            if time.monotonic() > end:
                raise Refusal(f"run: has told no live page within {BEGINS_WITHIN_S} s; see {self.log}")
            time.sleep(0.05)

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
