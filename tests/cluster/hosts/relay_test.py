"""Tests of three sites without common multicast, with a relay in each: forwarded and blocked messages, and a slow or missing site.
Real processes, hosts of a lab.

All tests share one cluster and run in the order of their names; each leaves it intact.
"""
import csv
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(REPOSITORY / "scripts" / "python"))
from tactus.cluster import lab_cluster
from tactus.launch.cluster import BIN
from tactus.refusal import Refusal

TIMEOUT_S = 180  # liveness: other tests run beside it
LINE = 7700
FILE = """<cluster name="sites">
  <bus ttl="1"/>
  <run scene="dark_room.sdf" budget="150ms"/>
  <host name="world" reach="ssh"/><host name="near" reach="ssh" site="near"/><host name="far" reach="ssh" site="far"/>
  <relays rules="wide" port="7700">
    <relay host="world" at="10.77.0.1"/><relay host="near" at="10.77.0.2"/><relay host="far" at="10.77.0.3" kbit="8000"/>
  </relays>
  <node name="sim_node" host="world"/><node name="recorder" host="world"/><node name="haptic_node" host="world"/>
  <node name="audio_node" host="near"/><node name="thermal_node" host="far"/>
  <node name="visual_node" host="far" options="--no-video">
    <set name="width" value="320"/><set name="height" value="240"/><set name="rate" value="20"/><set name="quality" value="3"/>
  </node>
</cluster>
"""
LATE = '<profile name="late"><degrade modality="audio" delay="20ms"/></profile>'


class Sites(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus-relay-test-"))
        path = cls.folder / "sites.xml"
        path.write_text(FILE, encoding="utf-8")
        cls.r = lab_cluster.LabCluster(path, cls.folder)
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.addClassCleanup(cls.r.close)
        cls.r.lab.sites([["world"], ["near"], ["far"]], LINE)
        cls.r.up()
        cls.expect_whole(cls)

    def expect_whole(self):
        if self.r.wait_until_running(TIMEOUT_S) is None:
            raise AssertionError(f"not whole: {({n: self.r.node_states.state(n) for n in self.r.placement})}")

    def wait(self, condition, what, patience_s=TIMEOUT_S):
        end = time.monotonic() + patience_s
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.05)

    def record_at(self, hosts, seconds):
        """{host: summary} of the messages that each host receives on its bus."""
        c, outs, recorders = self.r.cluster, {}, {}
        for host in hosts:
            outs[host] = self.folder / f"recorded_{host}"
            shutil.rmtree(outs[host], ignore_errors=True)
            outs[host].mkdir()
            words = [BIN / "recorder", "--out", outs[host], "--name", f"ear_{host}", "--run-id", self.r.node_states.run_id, "--group", c.bus.group, "--port", c.bus.port,
                     "--ttl", "0", "--tags", "none", "--seconds", 1]
            recorders[host] = subprocess.Popen([*self.r.lab.hosts[host].inside(), *map(str, words)], stderr=subprocess.DEVNULL)
        time.sleep(seconds)
        for recorder in recorders.values():
            recorder.terminate()
        for recorder in recorders.values():
            recorder.wait(20)
        summaries = {}
        for host, out in outs.items():
            subprocess.run([BIN / "summarise", out, "--out", out / "summary.json"], capture_output=True, check=False)
            summaries[host] = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        return summaries

    def rows(self, host, channel):
        """The messages of a channel in the last recording of record_at() there."""
        out = self.folder / f"recorded_{host}"
        subprocess.run([BIN / "export_log", out, "--out", out, "--channels", channel, "--wide"], check=True, capture_output=True)
        path = out / f"{channel}.csv"
        if not path.is_file():
            return []
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def channels(self, host):
        """All channels with a message in the recording there, of known or unknown type; read by LCM's log format."""
        data, at, found = (self.folder / f"recorded_{host}" / "run.lcmlog").read_bytes(), 0, set()
        while at + 28 <= len(data):
            channel, size = struct.unpack_from(">II", data, at + 20)
            found.add(data[at + 28:at + 28 + channel].decode())
            at += 28 + channel + size
        return found

    def incarnations(self):
        return {name: node["pid"] for s in self.r.states().values() for name, node in s["nodes"].items()}

    def note(self, relay):
        return self.r.node_states.newest.get(relay, {}).get("note", "")

    def test_10_every_site_presents_every_event_and_blocked_channels_do_not_cross(self):
        begin = time.monotonic()
        expected = {}
        while time.monotonic() < begin + TIMEOUT_S and not all(expected.get(m, 0) > 0 for m in ("audio", "visual")):
            summaries = self.record_at(["world", "far"], 4)
            for modality, m in summaries["world"]["contacts"]["by_modality"].items():
                expected[modality] = expected.get(modality, 0) + m["expected"]
                self.assertEqual(0, m["lost"], modality)
        self.assertGreater(expected["audio"], 0)
        self.assertGreater(expected["visual"], 0)
        self.assertGreater(len(self.rows("world", "TOUCH_MODEL")), 1000)
        self.assertEqual([], self.rows("far", "TOUCH_MODEL"))
        senders = {row["sender"] for row in self.rows("far", "CLOCK_PROBE")}
        self.assertLessEqual(senders, {"sync_node_far"})

    def test_11_the_hand_arrives_at_60_Hz_with_consecutive_numbers(self):
        self.record_at(["world", "far"], 4)
        first = lambda host: [row for row in self.rows(host, "TOOL_STATE") if row["sender"] == "haptic_node"]
        here, there = first("world"), first("far")
        time_s = lambda rows: float(rows[-1]["log_s"]) - float(rows[0]["log_s"])
        self.assertGreater(len(here) / time_s(here), 300)
        self.assertLess(len(there) / time_s(there), 63)
        self.assertGreater(len(there) / time_s(there), 50)
        numbers = [int(row["seq"]) for row in there]
        self.assertEqual(list(range(numbers[0], numbers[0] + len(numbers))), numbers, self.note("relay_world"))

    def test_12_messages_of_one_site_arrive_once_in_another(self):
        self.record_at(["near", "far"], 3)
        for host in ("near", "far"):
            for channel in ("PRESENTED", "NODE_HEALTH", "WORLD_STATE"):
                rows = self.rows(host, channel)
                seen = [(row["sender"], row["seq"]) for row in rows]
                self.assertGreater(len(seen), 0, (host, channel))
                self.assertEqual(len(set(seen)), len(seen), (host, channel))

    def test_20_a_profile_put_in_force_in_one_site_is_in_force_in_all(self):
        path = self.folder / "late.xml"
        path.write_text(LATE, encoding="utf-8")
        output = self.at("world", "degrade", str(path))
        self.assertEqual(0, output.returncode, output.stderr)

        def everywhere():
            self.record_at(["world"], 1.2)
            newest = {row["node"]: row["profile"] for row in self.rows("world", "NODE_HEALTH")}
            senses = [newest.get(n) for n in ("haptic_node", "audio_node", "visual_node", "thermal_node")]
            return None not in senses and len(set(senses)) == 1 and senses[0] != "0"
        self.wait(everywhere, "all modalities have the profile")
        self.assertEqual(0, self.at("world", "degrade", "off").returncode)

    def at(self, host, *words):
        c = self.r.cluster
        environment = dict(os.environ, TACTUS_GROUP=c.bus.group, TACTUS_PORT=str(c.bus.port), TACTUS_TTL=str(c.bus.ttl), TACTUS_RUN_ID=str(self.r.node_states.run_id))
        return subprocess.run([*self.r.lab.hosts[host].inside(), str(BIN / words[0]), *words[1:]], env=environment, capture_output=True, text=True, timeout=60, check=False)

    def test_30_a_slow_line_decimates_its_own_site_only(self):
        before = self.incarnations()
        self.r.lab.slow("far", 100)
        time.sleep(1)
        # The world itself sends more or less, so the sites are compared with it.
        summaries = self.record_at(["world", "near", "far"], 4)
        count = {host: len(self.rows(host, "WORLD_STATE")) for host in ("world", "near", "far")}
        self.assertGreater(count["near"], 0.9 * count["world"])
        self.assertLess(count["far"], 0.8 * count["world"])
        self.assertEqual(0, summaries["near"]["contacts"]["by_modality"]["audio"]["lost"])
        self.r.lab.slow("far", 0)
        self.expect_whole()
        self.assertEqual(before, self.incarnations())

    def test_31_a_disconnected_site_is_named_and_the_others_continue(self):
        before = self.incarnations()
        self.r.lab.hosts["far"].cut()
        self.wait(lambda: "10.77.0.3:7700: nothing received" in self.note("relay_near"), "the relay names the unreachable site")
        summaries = self.record_at(["near"], 3)
        self.assertEqual(0, summaries["near"]["contacts"]["by_modality"]["audio"]["lost"])
        for node in ("sim_node", "haptic_node", "audio_node"):
            self.wait(lambda: self.r.node_states.state(node) == "running", f"{node} runs without the disconnected site: {self.note(node)}")
        self.r.lab.hosts["far"].mend()
        self.expect_whole()
        self.assertEqual(before, self.incarnations())

    def test_32_a_killed_relay_restarts_by_itself(self):
        before = self.incarnations()
        self.r.operator.request("near", "send_command", names=["relay_near"], letter="k")
        self.wait(lambda: self.incarnations().get("relay_near") != before["relay_near"], "relay_near restarts")
        self.expect_whole()
        after = self.incarnations()
        self.assertNotEqual(before.pop("relay_near"), after.pop("relay_near"))
        self.assertEqual(before, after)

    def test_33_a_relay_cannot_be_moved(self):
        with self.assertRaisesRegex(Refusal, "expect it on this host"):
            self.r.operator.move("relay_near", "world")

    def test_34_datagrams_of_other_addresses_are_ignored(self):
        """The same bytes from the address of a relay that is down are accepted: a relay is identified by its address only."""
        header = struct.pack(">qqiqiqq", -1, 1, 1, self.r.node_states.run_id, 7, 1, 0)
        datagram = b"TRL1\0SIM_COMMAND\0" + bytes(8) + header + bytes(40)

        def arrives(port):
            program = f"import socket; s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM); s.bind(('10.77.0.2', {port})); s.sendto({datagram!r}, ('10.77.0.1', {LINE}))"
            sender = threading.Timer(1.0, lambda: subprocess.run([*self.r.lab.hosts["near"].inside(), sys.executable, "-c", program], check=True))
            sender.start()
            self.record_at(["world"], 2)
            sender.join()
            return "SIM_COMMAND" in self.channels("world")
        self.assertFalse(arrives(LINE + 1))
        self.r.operator.request("near", "stop", patience_s=20, names=["relay_near"], patience=3)
        self.assertTrue(arrives(LINE))
        self.r.operator.request("near", "start", patience_s=40, names=["relay_near"])
        self.expect_whole()

    def test_90_down_collects_all_results(self):
        wrong, ran = self.r.operator.down(self.folder / "results")
        self.assertEqual([], wrong)
        self.assertIsNotNone(ran)
        self.assertTrue((self.folder / "results" / "far" / "logs" / "relay_far.log").is_file())


if __name__ == "__main__":
    lab_cluster.enter(__file__, sys.argv[1:])
    unittest.main(verbosity=2, failfast=True)
