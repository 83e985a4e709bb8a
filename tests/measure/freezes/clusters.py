"""Processes of a cluster in this network, which can be stopped and continued."""
import os
import pathlib
import signal
import subprocess
import time

from common import ROOT, runs
from tactus.refusal import Refusal

SCENE = ROOT / "tests" / "cluster" / "scenes" / "pressed_and_tapped.sdf"
RELAY_RULES = pathlib.Path(__file__).resolve().parent / "relay_rules.xml"
RUN_ID = 4711
GROUP, PORT, FAR_PORT = "239.255.76.67", 7667, 7767
START_TIMEOUT_S = 60
WARM_UP_S = 5  # until the hand rests on the surface, the sounds are read and the picture has its first frames

# name: (program, arguments); the name is that of the process on the bus.
TOUCH = {
    "sync_node": ("sync_node", ()),
    "haptic_node": ("haptic_node", ("--tool", "hand")),
    "haptic_node_tapper": ("haptic_node", ("--tool", "tapper")),
}
SENSES = {
    "audio_node": ("audio_node", ("--audio-device", "virtual")),
    "thermal_node": ("thermal_node", ("--tool", "hand", "--set", "device=external")),
    "thermal_device": ("thermal_device", ("--tool", "0")),
}
PICTURES = {"visual_node": ("visual_node", ("--no-video", "--set", "width=320", "--set", "height=240"))}


class Cluster:
    """One cluster; with relays the senses are at a second site, which has another port of this machine."""

    def __init__(self, folder, relayed=False):
        """Starts it and waits until the hand has rested for a moment. Raises Refusal."""
        self.folder, self.processes = pathlib.Path(folder), {}
        try:
            self.start_all(relayed)
            self.wait_for_world()
        except BaseException:
            self.stop()
            raise

    def start_all(self, relayed):
        far = FAR_PORT if relayed else PORT
        for name, (program, words) in TOUCH.items():
            self.start(name, program, PORT, *words)
        for name, (program, words) in {**SENSES, **({} if relayed else PICTURES)}.items():
            self.start(name, program, far, *words)
        if relayed:
            for name, port, here, there in (("relay", PORT, 7700, 7701), ("relay_far", FAR_PORT, 7701, 7700)):
                self.start(name, "relay", port, "--listen", f"127.0.0.1:{here}", "--to", f"127.0.0.1:{there}", "--rules", str(RELAY_RULES))
            self.start("recorder_far", "recorder", FAR_PORT, out="far")
        self.start("recorder", "recorder", PORT)
        self.spawn("arm_driver", [runs.program("device_driver"), "arm", GROUP, str(PORT), str(RUN_ID)])
        self.start("sim_node", "sim_node", PORT, str(SCENE))

    def start(self, name, program, port, *words, out="."):
        folder = self.folder / out
        folder.mkdir(exist_ok=True)
        self.spawn(name, [runs.program(program), "--name", name, "--run-id", str(RUN_ID), "--port", str(port), "--out", str(folder), *words])

    def spawn(self, name, words):
        with open(self.log(name), "w", encoding="utf-8") as file:
            self.processes[name] = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT)

    def log(self, name):
        return self.folder / f"{name}.log"

    def wait_for_world(self):
        end = time.monotonic() + START_TIMEOUT_S
        while "the world begins" not in self.log("sim_node").read_text(encoding="utf-8", errors="replace"):
            self.require_alive()
            if time.monotonic() > end:
                raise Refusal(f"the simulation did not start within {START_TIMEOUT_S} s; use --keep DIR and see its log")
            time.sleep(0.05)
        time.sleep(WARM_UP_S)

    def require_alive(self):
        for name, process in self.processes.items():
            if process.poll() is not None:
                raise Refusal(f"{name} ended: {runs.last_line(self.log(name).read_text(encoding='utf-8', errors='replace'))}")

    def freeze(self, name, seconds):
        """Stops a process for a time. Returns (begin, end), CLOCK_MONOTONIC in ns: it stopped before begin and continued after end."""
        pid = self.processes[name].pid
        os.kill(pid, signal.SIGSTOP)
        begin_ns = time.monotonic_ns()
        time.sleep(seconds)
        end_ns = time.monotonic_ns()
        os.kill(pid, signal.SIGCONT)
        return begin_ns, end_ns

    def stop(self):
        """Ends all processes; the simulation first and the recorders last, so that the logs are complete."""
        last = [n for n in self.processes if n.startswith("recorder")]
        for names in (["sim_node"], [n for n in self.processes if n not in ("sim_node", *last)], last):
            for name in names:
                if name in self.processes:
                    self.processes[name].send_signal(signal.SIGCONT)
                    self.processes[name].terminate()
            for name in names:
                if name in self.processes:
                    self.end(self.processes[name])
        self.processes.clear()

    @staticmethod
    def end(process):
        try:
            process.wait(timeout=15)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
