"""Tests of a cluster on this machine and a network namespace of it, without ssh: start, move of a modality and end. Real processes."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(REPOSITORY / "scripts" / "python"))
from tactus.cluster import cluster_file, lab_cluster, status
from tactus.cluster.cluster_operator import Operator

TIMEOUT_S = 180  # liveness: other tests run beside it
FILE = """<cluster name="beside">
  <bus ttl="1"/>
  <run scene="metronome.sdf"/>
  <host name="here" reach="local"/><host name="beside" reach="namespace" address="room2"/>
  <node name="sim_node" host="here"/><node name="recorder" host="here"/><node name="audio_node" host="beside"/>
</cluster>
"""
NETWORK = ("mkdir -p /run/netns", "mount -t tmpfs tmpfs /run/netns", "ip link set lo up", "ip netns add room2", "ip link add to2 type veth peer name eth0 netns room2",
           "ip addr add 10.78.0.1/24 dev to2", "ip link set to2 up", "ip route add 224.0.0.0/4 dev to2", "ip -n room2 addr add 10.78.0.2/24 dev eth0",
           "ip -n room2 link set lo up", "ip -n room2 link set eth0 up", "ip -n room2 route add 224.0.0.0/4 dev eth0")


class Namespaces(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus-namespaces-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        os.environ["HOME"] = str(self.folder)
        for line in NETWORK:
            subprocess.run(line.split(), check=True)
        path = self.folder / "beside.xml"
        path.write_text(FILE, encoding="utf-8")
        self.operator = Operator(cluster_file.read(str(path), self.folder / "plan"), quiet=True)

    def wait(self, condition, what):
        end = time.monotonic() + TIMEOUT_S
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.2)

    def whole(self):
        return status.all_running(self.operator.cluster, *status.query(self.operator))

    def runs_at(self, node):
        return [host for host, s in self.operator.states(patience_s=TIMEOUT_S).items() if node in s["nodes"]]

    def test_a_node_runs_in_a_namespace_and_moves_out_of_it(self):
        self.operator.up("git")
        self.assertTrue(self.operator.wait_for_world())
        self.wait(self.whole, "all nodes run and are received")
        self.assertEqual(["beside"], self.runs_at("audio_node"))
        self.assertEqual(["here"], self.runs_at("sim_node"))
        self.operator.move("audio_node", "here")
        self.wait(self.whole, "all nodes run and are received after the move")
        self.assertEqual(["here"], self.runs_at("audio_node"))
        out = self.folder / "out"
        wrong, ran = self.operator.down(out)
        self.assertEqual([], wrong)
        self.assertIsNotNone(ran)
        self.assertTrue((out / "run.lcmlog").is_file())
        self.assertTrue((out / "beside" / "logs" / "audio_node.log").is_file())


if __name__ == "__main__":
    lab_cluster.enter(__file__, sys.argv[1:])
    unittest.main(verbosity=2)
