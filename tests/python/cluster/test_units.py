#!/usr/bin/env python3
"""Tests that tactus units installs valid, sandboxed systemd units with the priorities of the sources."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
KINDS = ("sync", "recorder", "haptic", "audio", "visual", "thermal", "sim", "relay", "path")
SOURCES = {"sync": "sync/tools/sync_node.cpp", "recorder": "sync/tools/recorder/recorder_node.cpp", "haptic": "haptic_node/run.cpp", "audio": "audio_node/run.cpp",
           "visual": "visual_node/run.cpp", "thermal": "thermal_node/run.cpp", "sim": "sim_node/run.cpp"}
MAX_EXPOSURE = 5  # systemd rates lower values as "OK"


def run(*words):
    return subprocess.run([ROOT / "scripts" / "tactus", "units", *map(str, words)], capture_output=True, text=True, check=False)


class Units(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not shutil.which("systemd-analyze"):
            raise unittest.SkipTest("systemd-analyze is not installed")
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        done = run("install", "--root", cls.root, "--units-only", "--only", ",".join(KINDS), "--port", 7700, "--ttl", 1, "--host", "wall", "--out", "/srv/tactus")
        assert done.returncode == 0, done.stderr
        cls.said = done.stdout
        cls.system = cls.root / "etc/systemd/system"
        # Units on which these depend, and the programs that they name.
        base = cls.root / "usr/lib/systemd/system"
        base.mkdir(parents=True)
        for path in [*pathlib.Path("/lib/systemd/system").glob("*.target"), *pathlib.Path("/lib/systemd/system").glob("*.slice")]:
            if path.is_file():
                shutil.copy(path, base)
        for unit in cls.system.glob("*.service"):
            program = cls.root / re.search(r"(?m)^ExecStart=/(\S+)", unit.read_text(encoding="ascii")).group(1)
            program.parent.mkdir(parents=True, exist_ok=True)
            program.write_text("#!/bin/sh\n", encoding="ascii")
            program.chmod(0o755)
        cls.names = [p.name.replace("@.", "@any.") for p in sorted(cls.system.iterdir())]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def analyze(self, what, *words):
        return subprocess.run(["systemd-analyze", what, f"--root={self.root}", "--no-pager", *words], capture_output=True, text=True, check=False)

    def last(self, kind, key):
        """The effective value of a key that occurs several times in a unit."""
        values = re.findall(rf"(?m)^{key}=(.*)$", (self.system / f"tactus-{kind}.service").read_text(encoding="ascii"))
        return values[-1] if values else None

    def test_nodes_that_read_foreign_files_may_confine_the_readers(self):
        """Readers of sync/sandbox limit their resources and use Landlock and seccomp."""
        for kind in ("sim", "audio", "haptic", "visual"):
            text = (self.system / f"tactus-{kind}.service").read_text(encoding="ascii")
            filters = re.findall(r"(?m)^SystemCallFilter=(.*)$", text)
            self.assertIn("landlock_create_ruleset landlock_add_rule landlock_restrict_self seccomp", filters)
            self.assertGreater(max(i for i, words in enumerate(filters) if "@resources" in words.split()),
                               next(i for i, words in enumerate(filters) if words.startswith("~")), kind)

    def test_systemd_accepts_every_unit(self):
        self.assertEqual(len(self.names), len(KINDS) + 3)
        done = self.analyze("verify", *self.names)
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))

    def test_systemd_rejects_a_damaged_unit(self):
        wrong = self.system / "wrong.service"
        self.addCleanup(wrong.unlink)
        wrong.write_text("[Service]\nExecStart=/opt/tactus/bin/missing\nProtectSysten=strict\n", encoding="ascii")
        said = self.analyze("verify", "wrong.service").stderr
        self.assertIn("ProtectSysten", said)
        self.assertIn("not executable", said)

    def test_each_unit_has_a_low_exposure(self):
        for name in self.names:
            if name.endswith(".target"):
                continue
            said = self.analyze("security", "--offline=true", name).stdout
            found = re.search(r"Overall exposure level for (\S+): ([0-9.]+)", said)
            print(f"{found.group(1)}: {found.group(2)}", file=sys.stderr)
            self.assertLess(float(found.group(2)), MAX_EXPOSURE, name)

    def test_priorities_are_those_of_the_sources(self):
        for kind, source in SOURCES.items():
            text = (ROOT / source).read_text(encoding="utf-8")
            declared = re.search(r"\.fifo_priority = (\d+)", text)
            renderer = ROOT / "audio_node" / "renderer.cpp"
            callback = kind == "audio" and re.search(r"kCallbackPriority = (\d+)", renderer.read_text(encoding="utf-8"))
            for unit in (kind, f"{kind}@") if kind in ("haptic", "visual") else (kind,):
                self.assertEqual(self.last(unit, "CPUSchedulingPriority"), declared and declared.group(1), unit)
                self.assertEqual(self.last(unit, "CPUSchedulingPolicy"), "fifo" if declared else None, unit)
                self.assertEqual(self.last(unit, "LimitRTPRIO"), (callback or declared).group(1) if declared else None, unit)
                self.assertEqual(self.last(unit, "LimitMEMLOCK"), "infinity" if declared else None, unit)
                self.assertEqual(self.last(unit, "RestrictRealtime"), "no" if declared else "yes", unit)
        architecture = {"audio": "70", "haptic": "60", "sim": "50", "sync": "40", "recorder": "40"}
        self.assertEqual({kind: self.last(kind, "LimitRTPRIO") for kind in architecture}, architecture)

    def test_options_are_written_to_the_environment_of_the_nodes(self):
        environment = (self.root / "etc/tactus/tactus.env").read_text(encoding="ascii")
        for line in ("TACTUS_PORT=7700", "TACTUS_TTL=1", "SYNC_OPTIONS=--name sync_node_wall", "TACTUS_GROUP=239.255.76.67"):
            self.assertIn(f"\n{line}\n", environment)
        for kind in SOURCES:
            self.assertEqual(self.last(kind, "ReadWritePaths"), "/srv/tactus")
        for path in self.root.glob("etc/**/*"):
            if path.is_file():
                self.assertNotRegex(path.read_text(encoding="ascii"), r"@[A-Z]+@", path)

    def test_no_unit_is_enabled(self):
        self.assertEqual([p for p in self.system.rglob("*") if p.is_symlink() or p.is_dir()], [])
        self.assertIn("nothing is enabled", self.said)

    def test_an_edited_environment_file_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run("install", "--root", folder, "--units-only").returncode, 0)
            file = pathlib.Path(folder) / "etc/tactus/tactus.env"
            file.write_text("TACTUS_PORT=1\n", encoding="ascii")
            self.assertIn("was kept", run("install", "--root", folder, "--units-only", "--port", "7700").stdout)
            self.assertEqual(file.read_text(encoding="ascii"), "TACTUS_PORT=1\n")
            self.assertFalse((pathlib.Path(folder) / "etc/systemd/system/tactus-path.service").exists(), "unless it is asked for")

    def test_each_invalid_argument_is_refused_with_one_sentence(self):
        for sentence, words in (("not a unit of \"smell\"", ["--only", "smell"]), ("absolute path", ["--prefix", "opt"]), ("absolute path", ["--out", "/a b"]),
                                ("from 0 to 255", ["--ttl", "256"]), ("not a multicast group", ["--group", "10.0.0.1"]), ("--host", ["--host", "a b"]),
                                ("is not a folder", ["--root", "/none/such"]), ("--help", ["--wrong"])):
            done = run("install", "--units-only", "--root", os.devnull, *words)
            self.assertEqual((done.returncode, done.stdout), (1, ""), words)
            self.assertRegex(done.stderr, r"\Aunits: [^\n]*" + re.escape(sentence) + r"[^\n]*\n\Z")


if __name__ == "__main__":
    unittest.main()
