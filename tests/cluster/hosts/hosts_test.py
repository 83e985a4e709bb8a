"""Tests of a cluster on three hosts of a lab, with real processes: start, move of a node, cut, split, late join and end.

All tests share one cluster and run in the order of their names; each leaves it intact.
"""
import csv
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
from tactus.cluster import lab_cluster
from tactus.cluster.host_connection import Failed
from tactus.launch.cluster import BIN
from tactus.refusal import Refusal

TIMEOUT_S = 180  # liveness: other tests run beside it
# A light scene: one test runs two clusters.
FILE = """<cluster name="{name}">
  <bus ttl="1" port="{port}"/>
  <run scene="metronome.sdf" budget="150ms"/>
  <host name="world" reach="ssh"/><host name="sound" reach="ssh"/><host name="picture" reach="ssh"{more}/>
  <node name="sim_node" host="world"/><node name="recorder" host="world"/><node name="haptic_node" host="world"/>
  <node name="audio_node" host="sound"/><node name="thermal_node" host="sound"/>
  <node name="visual_node" host="picture" options="--no-video">
    <set name="width" value="320"/><set name="height" value="240"/><set name="rate" value="20"/><set name="quality" value="3"/>
  </node>
</cluster>
"""
LATE = '<profile name="late"><degrade modality="{}" delay="{}ms"/></profile>'
SENSES = ("haptic_node", "audio_node", "visual_node", "thermal_node")


def write_file(folder, name="three", port=7667, more=""):
    path = folder / f"{name}.xml"
    path.write_text(FILE.format(name=name, port=port, more=more), encoding="utf-8")
    return path


class Hosts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus-hosts-test-"))
        cls.r = lab_cluster.LabCluster(write_file(cls.folder), cls.folder, ordinary=("sound",))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.addClassCleanup(cls.r.close)
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

    def at(self, host, *words):
        """Output of one of our programs, run with this host's view of the network."""
        c = self.r.cluster
        environment = dict(os.environ, TACTUS_GROUP=c.bus.group, TACTUS_PORT=str(c.bus.port), TACTUS_TTL=str(c.bus.ttl), TACTUS_RUN_ID=str(self.r.node_states.run_id))
        inside = self.r.lab.hosts[host].inside() if host else []
        return subprocess.run([*inside, str(BIN / words[0]), *words[1:]], env=environment, capture_output=True, text=True, timeout=60, check=False)

    def states_at(self, host):
        """{node: state} as received on that host."""
        import json
        output = self.at(host, "watch", "--once", "--json").stdout
        return {name: n["state"] for name, n in json.loads(output)["nodes"].items()} if output else {}

    def health(self, seconds=1.5):
        """{node: newest row of NODE_HEALTH} from an observer's log."""
        self.r.record("health", seconds)
        out = self.r.folder / "health"
        subprocess.run([BIN / "export_log", out, "--out", out, "--channels", "NODE_HEALTH", "--wide"], check=True, capture_output=True)
        with open(out / "NODE_HEALTH.csv", newline="", encoding="utf-8") as file:
            return {row["node"]: row for row in csv.DictReader(file)}

    def incarnations(self):
        """{node: incarnation}; a restarted process has another number."""
        return {name: node["pid"] for s in self.r.states().values() for name, node in s["nodes"].items()}

    def test_10_every_host_runs_its_nodes_of_the_file_from_its_own_build(self):
        states = self.r.states()
        for host, s in states.items():
            self.assertEqual(set(self.r.cluster.nodes_on(host)), set(s["nodes"]))
            for node in s["nodes"].values():
                self.assertTrue(node["up"])
        self.assertEqual(1, len({s["run"]["build"] for s in states.values()}))
        for name, host in self.r.lab.hosts.items():
            builds = list((host.home / ".local/share/tactus/builds").iterdir())
            self.assertEqual(1, len(builds), name)
        listing = subprocess.run(["nsenter", f"--mount=/proc/{self.r.lab.hosts['sound'].pid}/ns/mnt", "ls", str(REPOSITORY)], capture_output=True, text=True, check=False)
        self.assertEqual("", listing.stdout)

    def test_10_nodes_run_without_root_and_the_doctor_reports_missing_rights(self):
        users = {pathlib.Path(f"/proc/{p}").stat().st_uid for p in self.r.lab.hosts["sound"].processes() if self.name_of(p) in ("audio_node", "thermal_node", "sync_node")}
        self.assertEqual({1000}, users)
        self.assertIn("normal schedul", self.health()["audio_node"]["status_text"])
        _, wrong = self.doctor()
        output = [w for w in wrong if w.startswith("sound: SCHED_FIFO")]
        self.assertEqual(1, len(output), wrong)
        self.assertIn("person - rtprio 90", output[0])

    def name_of(self, process):
        return pathlib.Path(f"/proc/{process}/comm").read_text(encoding="ascii").strip()

    def test_11_a_second_up_changes_nothing(self):
        before = self.incarnations()
        self.r.operator.up("again")
        self.expect_whole()
        self.assertEqual(before, self.incarnations())

    def test_12_every_modality_presents_every_event_on_any_host(self):
        begin = time.monotonic()
        expected = {}
        while time.monotonic() < begin + TIMEOUT_S and not all(expected.get(m, 0) > 0 for m in ("audio", "visual")):
            summary = self.r.record("present", 4)
            for modality, m in summary["contacts"]["by_modality"].items():
                expected[modality] = expected.get(modality, 0) + m["expected"]
                self.assertEqual(0, m["lost"], modality)
        self.assertGreater(expected["audio"], 0)
        self.assertGreater(expected["visual"], 0)

    def test_13_the_doctor_finds_no_network_fault_and_the_true_clock_offsets(self):
        figures, wrong = self.doctor()
        between = [w for w in wrong if "receives nothing" in w or "loses" in w]
        self.assertEqual([], between)
        offset_s = lambda a, b: self.r.lab.hosts[b].ahead_s - self.r.lab.hosts[a].ahead_s
        for host, output in figures["pairs"].items():
            self.assertEqual(2, len(output["others"]))
            for other, o in output["others"].items():
                self.assertLessEqual(abs(o["offset_us"] - 1e6 * offset_s(host, other)), o["uncertainty_us"], (host, other))
                self.assertEqual(1, o["ttl"])
        self.assertEqual(set(self.r.lab.hosts), set(figures["hosts"]))

    def test_14_the_doctor_finds_a_firewall_and_a_lossy_cable(self):
        sound, picture = self.r.lab.hosts["sound"], self.r.lab.hosts["picture"]
        picture.lose(10)  # ten times the named loss; requests over ssh still pass
        drop = "add table inet deaf; add chain inet deaf input { type filter hook input priority 0; }; add rule inet deaf input udp dport 7669 drop"
        subprocess.run([*sound.inside(), "nft", drop], check=True)
        try:
            _, wrong = self.doctor()
        finally:
            subprocess.run([*sound.inside(), "nft", "delete table inet deaf"], check=True)
            picture.mend()
        self.assertTrue([w for w in wrong if w.startswith("sound: receives nothing from the other hosts")], wrong)
        self.assertTrue([w for w in wrong if w.startswith("world: loses") and "picture" in w], wrong)
        self.assertTrue([w for w in wrong if w.startswith("picture: loses") and "world" in w], wrong)
        self.expect_whole()

    def doctor(self):
        from tactus.cluster import checkup
        output, checkup.report = checkup.report, lambda *_: None
        try:
            return checkup.run(self.r.operator, 2)
        finally:
            checkup.report = output

    def test_20_a_moved_node_restarts_no_other_node(self):
        before = self.incarnations()
        self.r.operator.move("audio_node", "picture")
        self.r.placement["audio_node"] = "picture"
        self.wait(lambda: self.r.node_states.state("audio_node") == "running", "audio_node runs on its new host")
        states = self.r.states()
        self.assertIn("audio_node", states["picture"]["nodes"])
        self.assertNotIn("audio_node", states["sound"]["nodes"])
        self.r.operator.move("audio_node", "sound")
        self.r.placement["audio_node"] = "sound"
        self.expect_whole()
        after = self.incarnations()
        self.assertNotEqual(before.pop("audio_node"), after.pop("audio_node"))
        self.assertEqual(before, after)

    def test_21_impossible_moves_are_refused(self):
        for node, host, word in (("recorder", "sound", "recording"), ("sync_node", "sound", "each host"), ("sim_node", "sound", "--restart"),
                                 ("audio_node", "sound", "already"), ("audio_node", "cellar", "no such host"), ("nose_node", "sound", "no such node")):
            with self.subTest(node), self.assertRaisesRegex(Refusal, word):
                self.r.operator.move(node, host)

    def test_22_a_killed_node_rejoins_by_itself(self):
        before = self.incarnations()
        self.r.operator.request("sound", "send_command", names=["thermal_node"], letter="k")
        # Waits for the new process and not for the report of the loss: a process that is back before its silence is noticed is never lost.
        self.wait(lambda: self.incarnations().get("thermal_node") not in (None, 0, before["thermal_node"]), "thermal_node runs again")
        self.expect_whole()
        after = self.incarnations()
        self.assertNotEqual(before.pop("thermal_node"), after.pop("thermal_node"))
        self.assertEqual(before, after)

    def test_30_a_disconnected_host_holds_reports_it_and_recovers(self):
        before = self.incarnations()
        self.r.lab.hosts["sound"].cut()
        for node in ("audio_node", "thermal_node"):
            self.wait(lambda: self.states_at("sound").get(node) in ("stale", "input lost"), f"{node} reports its lost input")
        for node in ("sim_node", "haptic_node", "visual_node"):
            self.wait(lambda: self.r.node_states.state(node) == "running", f"{node} runs without the disconnected host")
        self.r.lab.hosts["sound"].mend()
        self.expect_whole()
        self.assertEqual(before, self.incarnations())

    def test_31_two_halves_keep_their_profiles_and_agree_on_the_newer_one_after_reunion(self):
        for name, delay in (("before", 10), ("here", 20), ("there", 30)):
            (self.folder / f"{name}.xml").write_text(LATE.format("audio", delay), encoding="utf-8")
        published = self.at("world", "degrade", str(self.folder / "before.xml"))
        self.assertEqual(0, published.returncode, published.stderr)
        before = self.incarnations()
        self.r.lab.split(["sound"])
        self.wait(lambda: self.states_at("sound").get("audio_node") in ("stale", "input lost"), "the half without the simulation reports its lost input")
        self.assertEqual("running", self.states_at("world").get("visual_node"))
        self.assertNotIn("sim_node", [n for n, s in self.states_at("sound").items() if s == "running"])
        here = self.at("world", "degrade", str(self.folder / "here.xml"))
        self.assertRegex(here.stderr + here.stdout, "no modality .audio. runs")  # the node runs in the other half: nothing was changed
        there = self.at("sound", "degrade", str(self.folder / "there.xml"))
        self.assertEqual(0, there.returncode, there.stderr)
        halves = {row["profile"] for name, row in self.health().items() if name in ("haptic_node", "visual_node")}
        self.assertEqual(1, len(halves), "the half with the simulation has one profile")
        self.r.lab.rejoin()
        self.expect_whole()

        def agreed():
            profiles = {name: row["profile"] for name, row in self.health().items() if name in SENSES}
            return len(profiles) == len(SENSES) and len(set(profiles.values())) == 1 and not halves & set(profiles.values())
        self.wait(agreed, "all modalities have the newer profile")
        self.assertEqual(before, self.incarnations())
        self.assertEqual(0, self.at("world", "degrade", "off").returncode)

    def test_40_a_host_after_a_power_loss_rejoins_with_scene_profile_and_clock(self):
        (self.folder / "slow.xml").write_text(LATE.format("thermal", 15), encoding="utf-8")
        self.assertEqual(0, self.at("world", "degrade", str(self.folder / "slow.xml")).returncode)
        before, processes = self.health(), self.incarnations()
        host = self.r.lab.hosts["picture"]
        host.kill()
        self.wait(lambda: self.r.node_states.state("visual_node") != "running", "visual_node is reported as lost")
        host.boot()
        self.r.operator.up("again")
        self.expect_whole()

        def joined():
            now = self.health()
            return now["visual_node"]["profile"] == before["haptic_node"]["profile"] and "3 other" not in now["sync_node"]["status_text"] and \
                "2 other clocks" in now["sync_node_picture"]["status_text"]
        self.wait(joined, "visual_node has the profile, and its host has the clocks of the others")
        after = self.incarnations()
        for name in ("sim_node", "haptic_node", "audio_node", "thermal_node", "recorder", "sync_node", "sync_node_sound"):
            self.assertEqual(processes[name], after[name], name)
        self.assertEqual(0, self.at("world", "degrade", "off").returncode)

    def test_41_an_absent_host_is_left_out_and_named(self):
        self.r.lab.hosts["picture"].cut()
        try:
            away = self.r.operator.up("again")
            self.assertEqual(["picture"], list(away))
        finally:
            self.r.lab.hosts["picture"].mend()
        self.expect_whole()

    def test_50_another_cluster_is_refused_on_the_same_port_and_isolated_on_another(self):
        from tactus.cluster.cluster_file import read
        from tactus.cluster.cluster_operator import Operator
        config = str(self.r.lab.folder / "ssh_config")
        same = Operator(read(str(write_file(self.folder, "second", 7667)), self.folder / "x"), config, quiet=True)
        with self.assertRaisesRegex(Refusal, "another cluster already uses"):
            same.up("second")
        other = Operator(read(str(write_file(self.folder, "second", 7777)), self.folder / "x"), config, quiet=True)
        before = self.incarnations()
        try:
            other.up("second")
            other.wait_for_world()
            rows, expected = {}, {*self.r.placement, "observer"}

            def is_complete():  # nodes without real-time priority publish late beside two clusters
                rows.update(self.health())
                return expected <= set(rows)
            self.wait(is_complete, "the health of all nodes")
            self.assertEqual(expected, set(rows))
            for name, row in rows.items():
                self.assertEqual("0", row["foreign_control"], name)
        finally:
            wrong, _ = other.down(self.folder / "second")
        self.assertEqual([], wrong)
        self.expect_whole()
        self.assertEqual(before, self.incarnations())

    def test_51_an_incompatible_build_is_refused_with_the_difference(self):
        from tactus.cluster.cluster_file import read
        from tactus.cluster.cluster_operator import Operator
        own = self.r.lab.hosts["picture"].home / "own" / "bin"
        own.mkdir(parents=True)
        output = subprocess.run([BIN / "message_types"], capture_output=True, text=True, check=True).stdout
        (own / "message_types").write_text("#!/bin/sh\ncat <<'X'\n" + output.replace("struct contact_events_t 0x", "struct contact_events_t 0xf") + "X\n", encoding="utf-8")
        (own / "message_types").chmod(0o755)
        path = write_file(self.folder, "mixed", 7787, ' build="~/own"')
        mixed = Operator(read(str(path), self.folder / "x"), str(self.r.lab.folder / "ssh_config"), quiet=True)
        with self.assertRaisesRegex(Refusal, "picture: the messages of its build differ: .*contact_events_t"):
            mixed.up("mixed")

    def test_90_down_collects_all_results_and_complete_logs(self):
        out = self.folder / "results"
        wrong, ran = self.r.operator.down(out)
        self.assertEqual([], wrong)
        self.assertIsNotNone(ran)
        for path in ("run.lcmlog", "logs/sim_node.log", "sound/logs/audio_node.log", "picture/logs/visual_node.log"):
            self.assertTrue((out / path).is_file(), path)
        self.assertTrue(list(out.glob("sound/audio*.wav")))
        described = subprocess.run([BIN / "replay", out / "run.lcmlog", "--describe"], capture_output=True, text=True, check=True).stdout
        self.assertIn('"recovered": ""', described)
        wrong, ran = self.r.operator.down(out)
        self.assertEqual(["no node of three runs"], wrong)
        for host in self.r.lab.hosts.values():
            names = {pathlib.Path(f"/proc/{p}/comm").read_text(encoding="ascii").strip() for p in host.processes()}
            self.assertFalse({"sim_node", "audio_node", "sync_node", "runsv", "runsvdir"} & names)


if __name__ == "__main__":
    lab_cluster.enter(__file__, sys.argv[1:])
    unittest.main(verbosity=2, failfast=True)
