"""Tests of the cluster file: valid files are read completely, invalid ones rejected with their line."""
import pathlib
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.cluster import cluster_file, commands
from tactus.refusal import Refusal

GOOD = """<cluster name="two">
  <bus ttl="1" port="7700" group="239.1.2.3"/>
  <run scene="dark_room.sdf" seed="5" policy="aligned"/>
  <host name="desk" reach="local"/>
  <host name="sound" reach="ssh" address="me@10.0.0.2" folder="~/t"/>
  <node name="sim_node" host="desk" realtime="require" cpus="0-1"/>
  <node name="recorder" host="desk"/>
  <node name="audio_node" host="sound" nice="3" options="--audio-device 'HDA Intel'">
    <set name="gain" value="0.5"/>
    <environment name="PULSE_SERVER" value="/run/pulse"/>
  </node>
  <walls room="cave4">
    <set name="width" value="320"/>
    <wall name="left" host="desk"/><wall name="front" host="desk"/><wall name="right" host="sound"><set name="width" value="640"/></wall><wall name="floor" host="sound"/>
  </walls>
</cluster>
"""


class ClusterFile(unittest.TestCase):
    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "c.xml"
            path.write_text(text, encoding="utf-8")
            return cluster_file.read(str(path), pathlib.Path(folder) / "out")

    def refused(self, text, *words):
        with self.assertRaises(Refusal) as caught:
            self.read(text)
        said = str(caught.exception)
        for word in words:
            self.assertIn(word, said)
        self.assertNotIn("\n", said)
        return said

    SITES = (("<host name=\"sound\"", "<host name=\"sound\" site=\"far\""),
             ("  <node name=\"sim_node\"", "  <relays rules=\"wide\"><relay host=\"desk\" at=\"192.0.2.7\"/><relay host=\"sound\" at=\"198.51.100.2\" kbit=\"2000\"/></relays>\n"
              "  <node name=\"sim_node\""), ("port=\"7700\"", "port=\"7667\""))

    def of_sites(self, *changes):
        text = GOOD
        for old, new in (*self.SITES, *changes):
            self.assertIn(old, text)
            text = text.replace(old, new)
        return text

    def test_each_site_has_a_relay_with_a_line_to_every_other(self):
        c = self.read(self.of_sites())
        self.assertEqual("sound", c.nodes["relay_sound"].host)
        words = commands.node_commands(c, 7, "git", {str(cluster_file.sites.SHIPPED): "@BUILD@/share/relays"})["relay_desk"]
        line = " ".join(words)
        for part in ("@BUILD@/bin/relay --name relay_desk --listen 192.0.2.7:7700 --to 198.51.100.2:7700,2000 --rules @BUILD@/share/relays/wide.xml", "--run-id 7",
                     "--group 239.1.2.3 --ttl 1"):
            self.assertIn(part, line)
        self.assertIn("--to 192.0.2.7:7700 ", " ".join(commands.node_commands(c, 7, "git", {})["relay_sound"]))

    def test_a_namespace_has_its_own_folder_and_a_second_local_host_is_refused(self):
        second = '<host name="sound" reach="{}"/>'
        of_file = '<host name="sound" reach="ssh" address="me@10.0.0.2" folder="~/t"/>'
        c = self.read(GOOD.replace(of_file, second.format("namespace")))
        self.assertEqual(("~/.local/share/tactus/hosts/sound", ""), (c.hosts["sound"].folder, c.hosts["desk"].folder))
        self.refused(GOOD.replace(of_file, second.format("local")), "c.xml:5: ", "is a second local host")

    def test_sites_without_relays_or_with_wrong_relays_are_refused(self):
        self.refused(GOOD.replace(*self.SITES[0]), "c.xml:5: ", "hosts of 2 sites and no relays")
        self.refused(GOOD.replace(*self.SITES[1]).replace("<relay host=\"sound\" at=\"198.51.100.2\" kbit=\"2000\"/>", ""), "one site, which needs no relay")
        self.refused(self.of_sites(("<relay host=\"desk\"", "<relay host=\"cellar\"")), "no host \"cellar\"")
        self.refused(self.of_sites(("<relay host=\"desk\" at=\"192.0.2.7\"/>", "")), "no host of the site of desk has a relay")
        self.refused(self.of_sites(("<relay host=\"desk\"", "<relay host=\"sound\"")), "already has a relay, on sound")
        self.refused(self.of_sites(("at=\"192.0.2.7\"", "at=\"desk\"")), "is not an IPv4 address")
        self.refused(self.of_sites(("rules=\"wide\"", "rules=\"narrow\"")), "rules=\"narrow\" is not a file", "all, wide")
        self.refused(self.of_sites(("kbit=\"2000\"", "kbit=\"2\"")), "kbit")
        self.refused(self.of_sites(("rules=\"wide\"", "rules=\"wide\" port=\"7668\"")), "a port of the bus")

    def test_a_complete_file_is_read(self):
        c = self.read(GOOD)
        self.assertEqual(cluster_file.Bus("239.1.2.3", 7700, 1), c.bus)
        self.assertEqual(["sim_node", "recorder", "visual_node", "visual_node_front", "sync_node"], c.nodes_on("desk"))
        self.assertEqual(["audio_node", "visual_node_right", "visual_node_floor", "sync_node_sound"], c.nodes_on("sound"))
        self.assertEqual(("--audio-device", "HDA Intel"), c.nodes["audio_node"].options)
        self.assertEqual((("PULSE_SERVER", "/run/pulse"),), c.nodes["audio_node"].environment)
        self.assertEqual(["haptic_node", "thermal_node"], sorted(n for n in c.plan.without))
        self.assertEqual(["gain=0.5"], c.plan.settings["audio_node"])
        self.assertEqual(["width=320"], c.plan.settings["visual_node"])
        self.assertEqual(["width=320", "width=640"], c.plan.settings["visual_node_right"])
        self.assertFalse(c.is_private())

    def test_every_shipped_file_is_valid(self):
        for path in cluster_file.SHIPPED.glob("*.xml"):
            with self.subTest(path.name):
                c = cluster_file.read(path.stem)
                self.assertEqual(path.stem, c.name)
                self.assertTrue(c.is_private() or c.bus.ttl == 1)

    def test_the_commands_of_a_node_name_the_folders_of_its_host(self):
        c = self.read(GOOD)
        words = commands.node_commands(c, 7, "abc", {str(cluster_file.arguments.SCENES): "@BUILD@/share/scenes"})
        audio = words["audio_node"]
        self.assertEqual(["env", "PULSE_SERVER=/run/pulse", "nice", "-n", "3", "@BUILD@/bin/audio_node"], audio[:6])
        self.assertEqual(["--group", "239.1.2.3", "--ttl", "1", "--audio-device", "HDA Intel"], audio[-6:])
        self.assertIn("@OUT@", audio)
        self.assertEqual(["taskset", "-c", "0-1"], words["sim_node"][:3])
        self.assertIn("@BUILD@/share/scenes/dark_room.sdf", words["sim_node"])
        self.assertEqual(["--realtime", "require"], words["sim_node"][-2:])
        self.assertEqual(1, words["sim_node"].count("--realtime"))
        self.assertEqual(["--name", "sync_node_sound"], words["sync_node_sound"][words["sync_node_sound"].index("--name"):][:2])
        for name, line in words.items():
            self.assertFalse([w for w in line if w.startswith(str(SCRIPTS.parent))], name)

    def test_errors_are_refused_with_their_line(self):
        for old, new, line, *words in (
                ('ttl="1"', 'ttl="0"', 2, "several hosts, but with ttl 0"),
                ('host="sound" nice', 'host="cellar" nice', 8, 'no host "cellar"', "desk, sound"),
                ('name="right" host', 'name="roof" host', 14, 'no wall "roof"', "left, front, right, floor"),
                ('<wall name="left" host="desk"/>', '', 12, "the wall left is on no host"),
                ('<node name="recorder" host="desk"/>', '', 1, "recorder is on no host"),
                ('<node name="sim_node" host="desk" realtime="require" cpus="0-1"/>', '', 1, "sim_node is on no host"),
                ('name="audio_node"', 'name="smell_node"', 8, '"smell_node"'),
                ('group="239.1.2.3"', 'group="10.1.2.3"', 2, "group"),
                ('group="239.1.2.3"', 'group="239.1.2.300"', 2, "not a multicast address"),
                ('nice="3"', 'nice="-3"', 8, "nice"),
                ('port="7700"', 'port="77000"', 2, "port"),
                ('folder="~/t"', 'folder="t"', 5, "not absolute"),
                ('reach="local"', 'reach="local" address="x"', 4, "local and has an address"),
                ('reach="local"', 'reach="telnet"', 4, "telnet"),
                ('reach="ssh" address="me@10.0.0.2"', 'reach="ssh" address="-oProxyCommand=x"', 5, "address"),
                ('name="sound" reach', 'name="desk" reach', 5, "desk"),
                ('</walls>', '</wals>', 15, ""),
                ("'HDA Intel'", "'HDA Intel", 8, "quotation"),
                ('<host name="desk" reach="local"/>', '<host name="desk" reach="local"/><bus/>', 4, "second <bus>"),
                ('<walls room="cave4">', '<node name="visual_node" host="desk"/><walls room="cave4">', 12, "remove one"),
                ('cpus="0-1"', 'cpus="all"', 6, "cpus"),
                ('<run scene', '<run colour="red" scene', 3, "colour")):
            with self.subTest(new or old):
                self.assertIn(old, GOOD)
                said = self.refused(GOOD.replace(old, new, 1), *words)
                self.assertIn(f"c.xml:{line}: ", said)

    def test_options_that_scripts_run_refuses_are_refused(self):
        self.refused(GOOD.replace('name="gain" value', 'name="loudness" value'), "c.xml:9: ", "no setting loudness")
        self.refused(GOOD.replace("dark_room.sdf", "bright_room.sdf"), "bright_room.sdf", "is not a file")
        self.refused(GOOD.replace('seed="5"', 'seed="5" keep="3"'), "--keep needs")

    def test_external_entities_are_not_read(self):
        said = self.refused('<!DOCTYPE cluster [<!ENTITY x SYSTEM "file:///etc/hostname">]>\n' + GOOD.replace('name="gain"', 'name="&x;"'))
        self.assertNotIn(pathlib.Path("/etc/hostname").read_text(encoding="utf-8").strip(), said)

    def test_a_missing_file_names_the_shipped_ones(self):
        with self.assertRaises(Refusal) as caught:
            cluster_file.read("nothing.xml")
        self.assertIn("cave4", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
