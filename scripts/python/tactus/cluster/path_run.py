"""Runs the default scene on two hosts of a lab, for tests/measure/measure_private_path: simulation and recorder on the first, all
modalities on the second."""
import collections
import contextlib
import json
import struct
import subprocess
import time

from tactus.cluster import intruder
from tactus.paths import BIN, SCENES

GROUP, PORT = "239.255.76.67", 7667
FIRST, SECOND = ("sync_node", "recorder", "sim_node"), ("sync_node_two", "haptic_node", "haptic_node_lamp", "audio_node", "visual_node", "thermal_node")
OPTIONS = {"sync_node_two": ["--name", "sync_node_two"], "haptic_node_lamp": ["--name", "haptic_node_lamp", "--tool", "lamp"],
           "audio_node": ["--audio-device", "virtual"],
           # Software rendering on the shared processors, therefore the cheapest settings.
           "visual_node": ["--no-video", *(w for s in ("width=320", "height=240", "rate=30", "quality=3") for w in ("--set", s))]}
SCENE = SCENES / "dark_room.sdf"
TIMEOUT_S = 60  # for a machine with other load
SELF_TEST = b"LCM_SELF_TEST"  # sent by each starting node, identical on both ports
STARVED_SHARE = 0.1  # share of missed ticks
EVENT, SYNC = 28, 0xEDA1DA01  # LCM's log format


class RunError(Exception):
    """A failed run; one sentence."""


def wait_until(holds, condition, timeout_s=TIMEOUT_S):
    end = time.monotonic() + timeout_s
    while not holds():
        if time.monotonic() > end:
            raise RunError(f"{condition} within {timeout_s} s")
        time.sleep(0.05)


class Run:
    """The running scene on both hosts, until end() or kill()."""

    def __init__(self, hosts, folder):
        self.hosts, self.folder, self.nodes = hosts, folder, {}
        self.read_to, self.seen, self.count = 0, set(), collections.Counter()
        folder.mkdir()
        for host, names in ((hosts[0], FIRST[:2]), (hosts[1], SECOND), (hosts[0], FIRST[2:])):
            for name in names:
                self.start(host, name)
        wait_until(lambda: "the world begins" in self.log_text("sim_node"), "sim_node: its world does not begin")
        wait_until(lambda: self.presentations() > 0, "no sense presents anything")

    def start(self, host, name):
        program = next(p for p in ("sync_node", "haptic_node", name) if name.startswith(p))
        out = self.folder / name
        out.mkdir()
        words = [*host.inside(), f"--time=/proc/{host.pid}/ns/time", str(BIN / program), *OPTIONS.get(name, []), *([str(SCENE)] if name == "sim_node" else []),
                 "--ttl", "1", "--port", str(PORT), "--out", str(self.folder if name == "recorder" else out)]
        with open(self.folder / f"{name}.log", "w", encoding="utf-8") as log:
            self.nodes[name] = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def log_text(self, name):
        return (self.folder / f"{name}.log").read_text(encoding="utf-8", errors="replace")

    def read_new_events(self):
        """Reads the new events of the log of the recorder."""
        with contextlib.suppress(FileNotFoundError), open(self.folder / "run.lcmlog", "rb") as file:
            file.seek(self.read_to)
            data, at = file.read(), 0
            while at + EVENT <= len(data):
                sync, _, _, name, size = struct.unpack(">IqqII", data[at:at + EVENT])
                if sync != SYNC:
                    raise RunError("the log is damaged")
                end = at + EVENT + name + size
                if end > len(data):
                    break
                event = data[at + EVENT:end]
                self.count["recorded"] += 1
                self.count["presentations"] += event.startswith(b"PRESENTED")
                self.count["forged"] += event.startswith(intruder.MARK)
                # The header has sender and sequence number, so an identical message was replayed.
                digest = hash(event)
                self.count["repeated"] += digest in self.seen and not event.startswith(SELF_TEST)
                self.seen.add(digest)
                at = end
            self.read_to += at

    def presentations(self):
        self.read_new_events()
        return self.count["presentations"]

    def end(self):
        """Stops the nodes. Returns figures of the bus as received by the recorder, and of expected events."""
        for names in (FIRST[2:], SECOND, FIRST[:1], FIRST[1:2]):
            for name in names:
                if self.nodes[name].poll() is not None:
                    raise RunError(f"{name}: ended by itself: {(self.log_text(name).strip() or 'silently').splitlines()[-1]}")
            time.sleep(0.3)  # until the last event is presented
            for name in names:
                self.nodes[name].terminate()
            for name in names:
                self.nodes[name].wait(TIMEOUT_S)
        self.read_new_events()
        subprocess.run([BIN / "summarise", self.folder, "--out", self.folder / "summary.json"], capture_output=True, check=False)
        try:
            summary = json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))
        except OSError:
            raise RunError("summarise: made no summary of the log") from None
        age = summary["nodes"]["haptic_node"]["input_age_ms"].get("TOUCH_MODEL", {}).get("p50")  # from host to host
        senses = {}
        for sense, counts in summary["contacts"]["by_modality"].items():
            node = summary["nodes"][f"{sense}_node"]
            # A node without enough processor time loses events without an attack.
            starved = node["missed_ticks"] > STARVED_SHARE * (node["ticks"] + node["missed_ticks"])
            senses[sense] = {**{what: counts[what] for what in ("expected", "presented", "lost")}, "starved": starved}
        return {**self.count, **{what: sum(s[what] for s in senses.values()) for what in ("expected", "presented", "lost")}, "senses": senses, "touch_age_ms": age}

    def kill(self):
        for process in self.nodes.values():
            if process.poll() is None:
                process.kill()
                process.wait()
