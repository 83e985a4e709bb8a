"""Client of the trial runner (scripts/trial_runner, program `conductor`): sends commands, stores observations, waits with time limits."""
import collections
import json
import os
import select
import subprocess
import time

from tactus.paths import tactus_command
from tactus.refusal import Refusal

MAX_STORED_EVENTS = 512  # events; ten times as many felt samples; design: a trial has a handful
MAX_STORED_PICTURES = 240  # 4 s at 60 Hz; design: longer than the time from a hit to the search for its flash
END_TIMEOUT_S = 3


class TrialRunnerClient:
    """A trial runner in the cluster whose results are in `out`. hand: (x, y, z, above) in m, if it holds the device. with_pictures: it also sends pictures."""

    def __init__(self, out, hand=None, with_pictures=False):
        words = [*tactus_command("attach"), str(out), "trial_runner", "--out", str(out)]
        if hand is not None:
            words += ["--hand", *(f"{x:g}" for x in hand[:3]), "--above", f"{hand[3]:g}"]
        words += ["--look"] if with_pictures else []
        self.process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        os.set_blocking(self.process.stdout.fileno(), False)
        os.set_blocking(self.process.stderr.fileno(), False)
        self.rest, self.stderr = b"", b""
        self.senses, self.senses_at_ns, self.sim_ns = {}, 0, None
        self.events = collections.OrderedDict()     # id: event
        self.presented = collections.OrderedDict()  # (id, modality, part): report
        self.media = {}                             # medium: deque of (index, at_ns)
        self.felt = collections.deque(maxlen=10 * MAX_STORED_EVENTS)  # (at_ns, z_m, force_N)
        self.pulses = collections.deque(maxlen=MAX_STORED_EVENTS)      # (at_ns, force_N): onset of the vibration of a hit
        self.pictures = collections.deque(maxlen=MAX_STORED_PICTURES)  # (at_ns, JPEG in base64)
        self.game, self.answer, self.in_force, self.moved, self.reply, self.asked = None, None, None, False, None, None
        self.refused = collections.deque(maxlen=16)

    def send(self, **what):
        """Sends one command. Raises Refusal if the trial runner has ended."""
        try:
            self.process.stdin.write(json.dumps(what).encode() + b"\n")
            self.process.stdin.flush()
        except OSError:
            raise Refusal(f"trial_runner: has ended ({self.last_output_line()}); check that the cluster is running") from None

    def last_output_line(self):
        try:
            self.stderr = (self.stderr + (os.read(self.process.stderr.fileno(), 65536) or b""))[-4096:]
        except OSError:
            pass
        return (self.stderr.decode(errors="replace").strip().splitlines() or ["no message"])[-1]

    def receive(self, timeout_s):
        """Reads pending observations, or waits up to timeout_s for some. Raises Refusal if the trial runner has ended."""
        ready, _, _ = select.select([self.process.stdout], [], [], timeout_s)
        if not ready:
            return
        data = os.read(self.process.stdout.fileno(), 1 << 20)
        if not data:
            raise Refusal(f"trial_runner: has ended ({self.last_output_line()}); check that the cluster is running")
        *lines, self.rest = (self.rest + data).split(b"\n")
        for line in lines:
            self.take(json.loads(line))

    def take(self, line):
        if "in_force" in line:
            self.in_force = line
        elif "senses" in line:
            self.senses, self.senses_at_ns, self.sim_ns = line["senses"], line["at_ns"], line.get("sim_ns")
        elif "event" in line:
            store_limited(self.events, line["event"], line)
        elif "presented" in line:
            store_limited(self.presented, (line["presented"], line["modality"], line["part"]), line)
        elif "medium" in line:
            self.media.setdefault(line["medium"], collections.deque(maxlen=64)).append((line["index"], line["at_ns"]))
        elif "felt" in line:
            self.felt.append((line["felt"]["at_ns"], line["felt"]["z_m"], line["felt"]["force_N"]))
        elif "pulse" in line:
            self.pulses.append((line["pulse"]["at_ns"], line["pulse"]["force_N"]))
        elif "picture" in line:
            if line["at_ns"] is not None:
                self.pictures.append((line["at_ns"], line["jpeg"]))
        elif "refused" in line:
            self.refused.append(line["refused"])
        elif "moved" in line:
            self.moved = True
        else:
            for name in ("game", "reply"):
                if name in line:
                    setattr(self, name, line[name])
            if "answer" in line:
                self.answer = line
            if "asked" in line:
                self.asked = line

    def wait_for(self, condition, timeout_s):
        """Waits until condition() is true; False after timeout_s. A refused command raises Refusal."""
        end = time.monotonic() + timeout_s
        while not condition():
            left = end - time.monotonic()
            if left <= 0:
                return False
            self.receive(min(left, 0.1))
            if self.refused:
                raise Refusal(f"trial_runner: {self.refused.popleft()}")
        return True

    def apply_profile(self, profile, timeout_s):
        """Whether every sense has the profile in time; then self.in_force holds its start in simulation time."""
        self.in_force = None
        self.send(profile=profile)
        return self.wait_for(lambda: self.in_force is not None, timeout_s)

    def missing(self):
        """Names of the nodes without the profile in force."""
        return sorted(name for name, s in self.senses.items() if not s["in_force"])

    def end(self):
        try:
            self.send(end=True)
        except Refusal:
            pass
        try:
            self.process.wait(END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def store_limited(store, key, value):
    store[key] = value
    while len(store) > MAX_STORED_EVENTS:
        store.popitem(last=False)
