"""Tests of check_sounds: reports and exit status for valid and damaged folders of recordings.

TACTUS_BIN: the folder of the programs.
"""
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import wave
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.commands import prepare
KITS = "/usr/share/hydrogen/data/drumkits"


def tone(path, length_s=0.5, level=0.5, rate_Hz=44100):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with wave.open(path, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate_Hz)
        file.writeframes(b"".join(struct.pack("<h", round(32767 * max(-1, min(1, level * math.cos(2764 * n / rate_Hz)))))
                                  for n in range(int(length_s * rate_Hz))))


def check(*arguments, command="check-sounds"):
    done = subprocess.run([ROOT / "scripts" / "tactus", command, *arguments], capture_output=True, text=True,
                          check=False)
    return done.returncode, done.stdout + done.stderr


class Missing(unittest.TestCase):
    def test_a_program_that_is_not_built_is_built_after_its_packages_are_installed(self):
        called = []
        with tempfile.TemporaryDirectory() as empty, mock.patch.object(prepare, "BIN", pathlib.Path(empty)), mock.patch.dict(os.environ), \
                mock.patch.object(prepare, "run_script", lambda *words: called.append([os.path.basename(words[0]), *words[1:]])):
            os.environ.pop("TACTUS_BIN", None)
            prepare.program("check_sounds")
        self.assertEqual([["setup", "--packages"], ["build", "check_sounds"]], called)


class CheckSounds(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = self.folder.name

    def tearDown(self):
        self.folder.cleanup()

    def place(self, name):
        return os.path.join(self.path, name)

    def test_a_complete_folder_exits_with_0_and_lists_the_fallbacks_of_a_scene(self):
        tone(self.place("steel-oak/impact/0.5.wav"))
        tone(self.place("oak/scrape/0.2.wav"), 1)
        scene = self.place("scene.sdf")
        with open(scene, "w", encoding="utf-8") as file:
            file.write('<sdf><surface material="oak"/><surface material="steel"/><surface material="felt"/></sdf>')
        code, text = check(self.path, "--scene", scene, "--json")
        self.assertEqual(code, 0, text)
        plays = {(p["materials"], p["interaction"]): p["plays"] for p in json.loads(text)["pairs"]}
        self.assertEqual(len(plays), 6 * 3)
        self.assertEqual(plays["oak-steel", "impact"], "pair")
        self.assertEqual(plays["oak-steel", "scrape"], "oak")
        self.assertEqual(plays["felt-steel", "impact"], "modal")
        self.assertEqual(check(self.path)[0], 0)

    def test_each_fault_is_reported_with_its_remedy_and_exit_status_1(self):
        tone(self.place("oak/impact/0.5.wav"))
        tone(self.place("oak/impact/1.wav"), level=0.0)
        tone(self.place("oak/impact/2.wav"), level=1.5)
        tone(self.place("oak/scrape/1.wav"), 0.1)
        with open(self.place("oak/impact/3.wav"), "wb"):
            pass
        code, text = check(self.path)
        self.assertEqual(code, 1)
        for name, word in (("impact/1.wav", "silent"), ("impact/2.wav", "clipped"), ("scrape/1.wav", "too short"),
                           ("impact/3.wav", "cannot be read")):
            line = next(line for line in text.splitlines() if name in line)
            self.assertIn(word, line)
        self.assertEqual(check(self.place("nowhere"))[0], 1)

    def test_the_default_set_is_complete(self):
        code, text = check("--scene", os.path.join(ROOT, "sim_node", "scenes", "materials_bench.sdf"), "--json")
        self.assertEqual(code, 0, text)
        report = json.loads(text)
        self.assertEqual(report["faults"], [])
        self.assertNotIn("modal", [p["plays"] for p in report["pairs"]])

    def test_the_default_set_is_rendered_identically_and_overwrites_no_folder(self):
        def make(name):
            return subprocess.run([os.path.join(os.environ["TACTUS_BIN"], "make_sounds"), self.place(name), "--materials",
                                   os.path.join(ROOT, "sim_node", "scenes", "materials.csv")], capture_output=True, check=False)

        self.assertEqual([make(name).returncode for name in ("a", "b", "b")], [0, 0, 0])
        files = [os.path.join(folder, name) for folder, _, names in os.walk(self.place("a")) for name in names]
        self.assertGreater(len(files), 100)
        for path in files:
            with open(path, "rb") as one, open(path.replace(self.place("a"), self.place("b")), "rb") as other:
                self.assertEqual(one.read(), other.read(), path)
        tone(self.place("mine/impact/1.wav"))
        self.assertEqual(make("mine").returncode, 1)
        self.assertTrue(os.path.exists(self.place("mine/impact/1.wav")))

    @unittest.skipUnless(os.path.isdir(KITS), "hydrogen-drumkits is not installed: no real recordings to test")
    def test_real_recordings_make_a_complete_folder(self):
        folder = self.place("drums")
        self.assertEqual(check(folder, command="drumkit-sounds")[0], 0)
        code, text = check(folder, "--json")
        self.assertEqual(code, 0, text)
        layers = {(s["materials"], s["interaction"]): len(s["layers"]) for s in json.loads(text)["sounds"]}
        self.assertEqual(layers["copper-oak", "impact"], 5)

    def test_a_missing_drum_package_and_an_invalid_scene_are_refused_with_one_sentence(self):
        for code, text in (check(self.place("drums"), "--from", self.place("none"), command="drumkit-sounds"),
                           check(self.path, "--scene", self.place("none.sdf"))):
            self.assertEqual(code, 1)
            self.assertEqual(len(text.strip().splitlines()), 1, text)


if __name__ == "__main__":
    unittest.main()
