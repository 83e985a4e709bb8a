"""Tests that a run names lost parts of its recording, busy ports, and advice that fits the place."""
import contextlib
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import main, network, services, virtual
from tactus.refusal import Refusal

FREE, FULL = (types.SimpleNamespace(f_bavail=blocks, f_frsize=4096) for blocks in (10**6, 3))


class Recording(unittest.TestCase):
    def errors(self, line="", deaths=(), disk=FREE):
        with mock.patch.object(main.os, "statvfs", lambda _: disk):
            return main.incomplete_recording(pathlib.Path("/out"), line, list(deaths))

    def test_a_complete_recording_has_no_error(self):
        self.assertEqual([], self.errors())

    def test_a_recorder_that_died_is_named_with_its_signal(self):
        (said,) = self.errors(deaths=["signal 11", "signal 25"])
        self.assertIn("recorder: died 2 times, the last time by signal 25", said)

    def test_a_disk_that_refused_the_log_is_named_with_the_lost_messages(self):
        line = "recorder: /out/run.lcmlog: the disk refuses the log (File too large); 70 events, 800 lost because the disk is full or too slow"
        self.assertTrue(self.errors(line)[-1].startswith(line + "; free space, raise the limit of file sizes"))

    def test_a_sound_file_that_the_disk_refused_is_an_error_with_the_place_of_its_end(self):
        line = "audio_node: plays on virtual card into audio.wav; the disk refuses the sound (File too large): audio.wav ends after 1.3 s"
        (said,) = main.incomplete_sound([line])
        self.assertTrue(said.startswith(f"{line}; free space, raise the limit of file sizes"))
        text = (pathlib.Path(__file__).resolve().parents[3] / "audio_node/devices/stream.cpp").read_text(encoding="utf-8")
        for words in main.SOUND_LOST:
            self.assertIn(f'"{words}', text)
        self.assertEqual([], main.incomplete_sound([]))

    def test_a_video_that_ends_early_is_found_in_the_output_of_its_node(self):
        line = "visual_node: the video ends early: its encoder has died"
        with tempfile.TemporaryDirectory() as kept:
            folder = pathlib.Path(kept)
            (folder / "services").mkdir()
            nodes = {name: services.Service(folder, name, ["true"], folder / f"{name}.log", folder) for name in ("visual_node", "audio_node")}
            (folder / "visual_node.log").write_text(f"visual_node: 60 Hz\n{line}\nvisual_node: the window was closed\n", encoding="utf-8")
            self.assertEqual([line], main.lines_with(main.VIDEO_ENDS, nodes))
        text = (pathlib.Path(__file__).resolve().parents[3] / "visual_node/video/recording.cpp").read_text(encoding="utf-8")
        self.assertIn(f'"{main.VIDEO_ENDS[0]}', text)

    def test_a_full_disk_is_named_also_when_the_log_of_the_recorder_is_on_it(self):
        self.assertIn("the disk of /out is full", self.errors(disk=FULL)[-1])


class StoppedWorld(unittest.TestCase):
    # As in sim_node/world/simulation.cpp.
    SAID = "sim_node: the position of the body ball is not finite after step 7, at 0.007 s, so the world stops; correct its mass"

    def test_a_world_that_stopped_is_an_error_with_its_sentence_although_it_was_restarted(self):
        with tempfile.TemporaryDirectory() as kept:
            folder = pathlib.Path(kept)
            (folder / "services").mkdir()
            service = services.Service(folder, "sim_node", ["true"], folder / "log", folder)
            (folder / "log").write_text(f"sim_node: the world begins\n{self.SAID}\nsim_node: the world begins\n", encoding="utf-8")
            said = service.last_line_with([main.WORLD_STOPPED])
        self.assertEqual([f"{self.SAID}; see /out/logs/sim_node.log"], main.stopped_world("/out", said))
        self.assertEqual([], main.stopped_world("/out", ""))

    def test_in_virtual_time_its_sentence_comes_before_the_last_line(self):
        self.assertEqual(self.SAID, virtual.reason(f"sim_node: the world begins\n{self.SAID}\nvirtual_time: the end\n"))
        self.assertEqual("virtual_time: no file", virtual.reason("virtual_time: no file\n"))

    def test_the_words_are_those_of_the_simulation(self):
        text = (pathlib.Path(__file__).resolve().parents[3] / "sim_node/world/simulation.cpp").read_text(encoding="utf-8")
        self.assertIn(main.WORLD_STOPPED, text)


class Deaths(unittest.TestCase):
    def test_the_line_about_refused_messages_is_found_before_later_ones(self):
        with tempfile.TemporaryDirectory() as kept:
            folder = pathlib.Path(kept)
            (folder / "services").mkdir()
            service = services.Service(folder, "recorder", ["true"], folder / "log", folder)
            self.assertEqual("", service.last_line_with(main.REFUSED))
            line = "recorder: run.lcmlog: the disk refuses the log (File too large); 7 events"
            (folder / "log").write_text(f"recorder: writing run.lcmlog\n{line}\nrecorder: run.lcmlog is incomplete; free space on its disk\n", encoding="utf-8")
            self.assertEqual(line, service.last_line_with(main.REFUSED))

    def test_the_way_of_each_death_is_kept(self):
        with tempfile.TemporaryDirectory() as kept:
            folder = pathlib.Path(kept)
            (folder / "services").mkdir()
            service = services.Service(folder, "recorder", ["true"], folder / "log", folder)
            for words in (["-1", str(int(signal.SIGXFSZ))], ["3", "0"]):
                subprocess.run([service.path / "finish", *words], cwd=service.path, check=True)
            self.assertEqual([f"signal {int(signal.SIGXFSZ)}", "exit code 3"], service.death_reasons())
            self.assertEqual(2, service.deaths())
            (folder / "stopping").touch()  # an end that was asked for is no death
            subprocess.run([service.path / "finish", "-1", "15"], cwd=service.path, check=True)
            self.assertEqual(2, service.deaths())


@contextlib.contextmanager
def bound(port, shared):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        if shared:
            s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        s.bind(("", port))
        yield s


class HostNetwork(unittest.TestCase):
    """In a network namespace of its own, so that no run of this machine is received."""

    CODE = ("import sys; sys.path[:0] = {paths!r}; import unittest, test_lost_parts; "
            "sys.exit(not unittest.TextTestRunner().run(unittest.defaultTestLoader.loadTestsFromName('Inside', test_lost_parts)).wasSuccessful())")

    def test_only_a_sender_and_an_exclusive_program_are_obstacles(self):
        here = pathlib.Path(__file__).resolve().parent
        code = self.CODE.format(paths=[str(here)])
        for flags in (["-n"], ["-rn"]):
            done = subprocess.run(["unshare", *flags, "sh", "-c", 'PATH=$PATH:/usr/sbin:/sbin; ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"', "sh",
                                   "/usr/bin/python3", "-c", code], capture_output=True, text=True, check=False)
            if "test" in done.stderr:
                self.assertEqual(0, done.returncode, done.stderr)
                return
        self.skipTest("no network namespace is allowed here")


class Inside(unittest.TestCase):
    PORT = 7667

    def setUp(self):
        if not os.path.exists("/proc/net/dev") or len(pathlib.Path("/proc/net/dev").read_text(encoding="ascii").splitlines()) > 3:
            self.skipTest("runs in a network namespace with only a loopback")

    def refusal(self, private=True):
        with self.assertRaises(Refusal) as caught:
            network.check_host(self.PORT, private)
        return str(caught.exception)

    def test_a_free_port_and_a_program_that_only_listens_are_accepted(self):
        network.check_host(self.PORT)
        with bound(self.PORT, shared=True):  # lcm-logger
            network.check_host(self.PORT)

    def test_a_program_that_does_not_share_the_port_is_refused(self):
        with bound(self.PORT + 1, shared=False):
            self.assertIn(f"UDP port {self.PORT + 1} is in use by a program that does not share it", self.refusal())

    def test_another_run_is_refused_and_the_advice_fits_the_place(self):
        over = threading.Event()

        def send():
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
                s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
                while not over.wait(0.01):
                    s.sendto(struct.pack(">II", 0x4C433032, 1) + b"X\0", (network.GROUP, self.PORT))
        sender = threading.Thread(target=send)
        sender.start()
        try:
            self.assertIn("another run or program sends", self.refusal())
            self.assertIn("--network private", self.refusal())
            self.assertNotIn("--network private", self.refusal(private=False))
        finally:
            over.set()
            sender.join()


if __name__ == "__main__":
    unittest.main()
