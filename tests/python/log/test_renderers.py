"""Tests of the renderers with a log that they cannot use: the refusal names it."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from log_files import BIN, make_run, write_log

OUTPUTS = {"audio_node": "--wav", "haptic_node": "--trace", "thermal_node": "--trace", "visual_node": "--video"}


class Renderers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.events = make_run(cls.folder / "run", "metronome.sdf", 1)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_a_log_without_a_scene_or_tool_is_refused_with_its_name_and_a_remedy(self):
        without = lambda *channels: [event for event in self.events if event[1] not in channels]
        for what, events, nodes in (("no scene", without(b"SCENE_MANIFEST", b"ASSET_CHUNK"), tuple(OUTPUTS)), ("no TOOL_STATE", without(b"TOOL_STATE"), ("haptic_node",))):
            log = self.folder / f"{what.replace(' ', '_')}.lcmlog"
            write_log(log, events)
            for node in nodes:
                with self.subTest(f"{node}, {what}"):
                    done = subprocess.run([BIN / node, "--log", log, OUTPUTS[node], self.folder / f"{node}.out"], capture_output=True, text=True, check=False,
                                          cwd=self.folder, env=os.environ)
                    self.assertEqual(1, done.returncode, done.stderr)
                    self.assertRegex(done.stderr.strip().splitlines()[-1], rf"^{node}: .*{log.name}: the log has {what}.*; ")


if __name__ == "__main__":
    unittest.main()
