"""Tests that a sound server that does not answer is reported when the user wants to listen."""
import os
import pathlib
import socket
import sys
import tempfile
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import equipment, sound_server


class Server(unittest.TestCase):
    def test_every_form_of_the_variable_is_understood(self):
        for entry, expected in (("unix:/run/a", (socket.AF_UNIX, "/run/a")), ("/run/a", (socket.AF_UNIX, "/run/a")), ("{0123}unix:/run/a", (socket.AF_UNIX, "/run/a")),
                                ("tcp:host:99", (socket.AF_INET, ("host", 99))), ("tcp4:host", (socket.AF_INET, ("host", 4713))), ("host", (socket.AF_INET, ("host", 4713))),
                                ("host:5", (socket.AF_INET, ("host", 5))), ("tcp6:[::1]:7", (socket.AF_INET, ("::1", 7)))):
            self.assertEqual(expected, sound_server.place(entry), entry)

    def test_a_dead_server_is_reported_and_a_living_one_is_not(self):
        plan = types.SimpleNamespace(listen=True, without=["visual_node"])
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX) as living:
            living.bind(f"{folder}/native")
            living.listen(4)
            for variable, dead in ((f"unix:{folder}/none", True), ("tcp:127.0.0.1:1", True), (f"unix:{folder}/" + "a" * 200, True), (f"unix:{folder}/native", False),
                                   (f"tcp:127.0.0.1:1 unix:{folder}/native", False)):
                with mock.patch.dict(os.environ, {"PULSE_SERVER": variable}):
                    said = equipment.missing_equipment(plan)
                self.assertEqual(dead, any("does not answer" in sentence for sentence in said), (variable, said))

    def test_nothing_is_reported_without_listen(self):
        with mock.patch.dict(os.environ, {"PULSE_SERVER": "tcp:127.0.0.1:1"}):
            self.assertEqual([], equipment.missing_equipment(types.SimpleNamespace(listen=False, without=["visual_node"])))


if __name__ == "__main__":
    unittest.main()
