#!/usr/bin/env python3
"""Tests of tactus private-path: keys readable only by their owner, configurations that keep the bus inside, one sentence for wrong arguments."""
import os
import pathlib
import re
import stat
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
TACTUS = ROOT / "scripts" / "tactus"


def run(*words):
    return subprocess.run([TACTUS, "private-path", *map(str, words)], capture_output=True, text=True, check=False)


class Refusals(unittest.TestCase):
    def refused(self, sentence, *words):
        done = run(*words)
        self.assertEqual((done.returncode, done.stdout), (1, ""), words)
        self.assertRegex(done.stderr, r"\Aprivate_path: [^\n]*" + sentence + r"[^\n]*\n\Z")

    def test_each_invalid_argument_is_refused_with_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out")
            good = {"--hosts": "a,b", "--server": "192.0.2.1", "--out": out}
            def make(**changed):
                words = {**good, **{"--" + k: v for k, v in changed.items()}}
                return ["make", *(w for pair in words.items() for w in pair)]
            self.refused("2 to 250 hosts", *make(hosts="a"))
            self.refused("named twice", *make(hosts="a,a"))
            self.refused("not a valid host name", *make(hosts="a,../b"))
            self.refused("not a valid host name", *make(hosts="a,"))
            self.refused("authority is the folder", *make(hosts="a,authority"))
            self.refused("not an IPv4 address", *make(server="239.0.0.1"))
            self.refused("not an IPv4 address", *make(server="::1"))
            self.refused("neither an address nor a name", *make(server="1.2.3"))
            self.refused("neither an address nor a name", *make(server="a b"))
            self.refused("from 1 to 65534", *make(port="65535"))
            self.refused("--days", *make(days="0"))
            self.refused("already exists", *make(out=folder))
            self.refused("--help", "make", "--hosts", "a,b")
            self.refused("--help", "mace")
            self.refused("not a network device", "macsec", "--hosts", "a,b", "--device", "eth0; ls")
            self.assertEqual(os.listdir(folder), [], "a refusal leaves nothing behind")


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name) / "path"
        done = run("make", "--hosts", "desk,sound,wall", "--server", "lab.example.org", "--out", cls.out, "--port", 7700, "--listen", 1200)
        assert done.returncode == 0, done.stderr
        cls.said = done.stdout

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def conf(self, name):
        return (self.out / name / "tactus.conf").read_text(encoding="ascii")

    def part(self, name, element):
        return re.search(rf"<{element}>\n(.*?\n)</{element}>", self.conf(name), re.S).group(1)

    def test_only_the_owner_can_read_the_files(self):
        for path in [self.out, *self.out.rglob("*")]:
            self.assertEqual(stat.S_IMODE(path.stat().st_mode) & 0o077, 0, path)

    def test_the_first_host_listens_and_the_others_connect_to_it(self):
        self.assertRegex(self.conf("desk"), r"(?m)^lport 1200$")
        for name in ("sound", "wall"):
            self.assertRegex(self.conf(name), r"(?m)^remote lab\.example\.org 1200$")
            self.assertRegex(self.conf(name), r"(?m)^verify-x509-name desk name$")

    def test_the_authority_signs_each_key_for_its_use_and_is_in_no_folder_of_a_host(self):
        key = (self.out / "authority" / "ca.key").read_text(encoding="ascii")
        for name, purpose, other in (("desk", "sslserver", "sslclient"), ("sound", "sslclient", "sslserver"), ("wall", "sslclient", "sslserver")):
            verify = lambda use: subprocess.run(["openssl", "verify", "-CAfile", self.out / "authority" / "ca.crt", "-purpose", use], capture_output=True,
                                                input=self.part(name, "cert"), text=True, check=False).returncode
            self.assertEqual(verify(purpose), 0)
            self.assertNotEqual(verify(other), 0)
            self.assertNotIn(key, self.conf(name))
        self.assertEqual(len({self.part(name, "key") for name in ("desk", "sound", "wall")}), 3)

    def test_the_rules_name_both_ports_of_the_bus(self):
        for name in ("desk", "sound", "wall"):
            rules = (self.out / name / "tactus.nft").read_text(encoding="ascii")
            self.assertEqual(rules.count('!= { "lo", "tactus0" } udp dport { 7700, 7701 } counter drop'), 2)

    def test_two_paths_have_no_common_key(self):
        again = self.out.with_name("again")
        self.assertEqual(run("make", "--hosts", "desk,sound", "--server", "lab.example.org", "--out", again).returncode, 0)
        self.assertNotEqual((again / "desk" / "tactus.conf").read_text(encoding="ascii").split("<tls-crypt>")[1], self.part("desk", "tls-crypt"))

    def test_macsec_gives_each_host_the_keys_of_the_others(self):
        said = run("macsec", "--hosts", "desk,sound,wall", "--device", "eth0").stdout
        parts = said.split("# on ")[1:]
        self.assertEqual(len(parts), 3)
        own = [re.search(r"tx sa 0 pn 1 on key \S+ (\S+)", part).group(1) for part in parts]
        for n, part in enumerate(parts):
            self.assertEqual(re.findall(r"rx port 1 address \S+ sa 0 pn 1 on key \S+ (\S+)", part), [k for m, k in enumerate(own) if m != n])
            self.assertIn('oifname != { "lo", "macsec0" }', part)
            before, inside, after = re.split(r"ip -batch - << 'KEYS'\n|^KEYS\n", part, flags=re.MULTILINE)
            self.assertEqual((0, 3), (sum(key in before + after for key in own), sum(key in inside for key in own)), "a key is an argument of a program")


if __name__ == "__main__":
    unittest.main()
