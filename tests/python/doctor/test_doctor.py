#!/usr/bin/env python3
"""Tests of `tactus doctor`: each fault is simulated, and figures are compared with the machine."""
import json
import os
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.doctor import bus, clocks, devices, realtime, sandbox
from tactus.doctor.line import GOOD, MISSING, WEAK, Line

LCM = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d"}


def layout(name):
    """The struct format of a message type with only numbers."""
    text = next((ROOT / "lcmtypes" / "types").glob(f"*/{name}.lcm")).read_text()
    fields = re.findall(r"^\s*(\w+) (\w+);", re.sub(r"//.*", "", text), re.M)
    return ">" + "".join(LCM[kind] for kind, _ in fields if kind in LCM)


def namespaces():
    return subprocess.run(["unshare", "-n", "true"], capture_output=True, check=False).returncode == 0


class Bus(unittest.TestCase):
    def test_a_network_without_multicast_is_reported_with_the_remedy(self):
        if not namespaces():
            self.skipTest("this system allows no network namespace")
        code = ("import sys; sys.path.insert(0, sys.argv[1]); from tactus.doctor import bus\n"
                "for line in (bus.route(), bus.loopback()): print(line.verdict, line.remedy)")
        for setup, verdict in (("true", WEAK), ("ip link set lo up && ip route add 224.0.0.0/4 dev lo", GOOD)):
            said = subprocess.run(["unshare", "-n", "sh", "-c", f"{setup} && exec python3 -c '{code}' {ROOT}/scripts/python"],
                                  capture_output=True, text=True, check=True).stdout.splitlines()
            self.assertEqual([line.split()[0] for line in said], [verdict, verdict])
            if verdict == WEAK:
                self.assertTrue(all("ip route add" in line for line in said))

    def test_the_bus_is_missing_only_without_both_networks(self):
        for private in (True, False):
            for loop in (GOOD, WEAK):
                lines = [bus.namespaces(private), Line("multicast loopback", loop, "")]
                bus.mark_required_network(lines)
                self.assertEqual(lines[0].needed, not private and loop != GOOD)
                self.assertEqual(lines[0].verdict == MISSING, lines[0].needed)

    def test_small_buffers_are_weak(self):
        with mock.patch.object(bus.socket.socket, "setsockopt", side_effect=[OSError, None]), \
             mock.patch.object(bus.socket.socket, "getsockopt", return_value=2 * 212992):
            line = bus.receive_buffer()
        self.assertEqual(line.verdict, WEAK)
        self.assertEqual(line.figures["given_bytes"], 212992)
        self.assertIn("rmem_max", line.remedy)


class Clocks(unittest.TestCase):
    def test_the_layout_of_a_clock_map_agrees_with_its_type(self):
        self.assertEqual(clocks.HEADER, layout("header_t"))
        self.assertEqual(clocks.MAP, layout("clock_map_t"))

    def packet(self, of=1, to=2, offset=5_000_000, uncertainty=30_000):
        return (struct.pack(">II", clocks.SMALL, 7) + b"CLOCK_MAP\0" + b"12345678" + struct.pack(clocks.HEADER, -1, 9, of, 1, 3, 4, 5)
                + struct.pack(clocks.MAP, of, to, 9, offset, 0.0, uncertainty, 0.0, 1, 2, 3))

    def test_only_clock_maps_are_read(self):
        packet = self.packet()
        self.assertEqual(clocks.map_of(packet), (1, 2, 5_000_000, 30_000))
        for length in range(len(packet)):
            self.assertIsNone(clocks.map_of(packet[:length]))
        self.assertIsNone(clocks.map_of(packet.replace(b"CLOCK_MAP", b"CLOCK_MOP")))
        noise = random.Random(1)
        for _ in range(1000):
            self.assertIsNone(clocks.map_of(noise.randbytes(noise.randrange(300))))

    def test_uncertain_clocks_are_weak(self):
        for uncertainty, verdict in ((0.9, GOOD), (1.1, WEAK)):
            with mock.patch.object(clocks, "listen", return_value=({(1, 2): (5e6, uncertainty * 1e6)}, 10)):
                line = clocks.offsets(7667)
            self.assertEqual(line.verdict, verdict)
            self.assertEqual(line.figures["hosts"], 2)
            self.assertEqual(line.figures["maps"][0]["offset_ms"], 5)


class Sandbox(unittest.TestCase):
    def test_a_kernel_without_landlock_or_seccomp_is_weak_with_the_risk_and_the_remedy(self):
        for version, filters, lacks, risk in ((0, True, "no Landlock:", "read other files of the user"), (3, False, "no seccomp filters:", "use the network"),
                                              (0, False, "no Landlock and no seccomp filters:", "read other files of the user and use the network")):
            line = sandbox.confinement(lambda v=version: v, lambda f=filters: f)
            self.assertEqual(line.verdict, WEAK)
            self.assertIn(lacks, line.found)
            self.assertTrue(line.found.endswith(risk), line.found)
            self.assertIn("lsm=landlock", line.remedy)
        self.assertEqual(sandbox.confinement(lambda: 1, lambda: True).verdict, GOOD)

    def test_the_measures_of_this_kernel_are_found(self):
        modules = pathlib.Path("/sys/kernel/security/lsm")
        if modules.exists():
            self.assertEqual(sandbox.landlock_version() > 0, "landlock" in modules.read_text().split(","))
        self.assertEqual(sandbox.has_seccomp(), "Seccomp:" in pathlib.Path("/proc/self/status").read_text())


class Realtime(unittest.TestCase):
    def test_a_refused_priority_is_reported_with_the_remedy(self):
        with mock.patch.object(realtime.os, "sched_setscheduler", side_effect=PermissionError(1, "Operation not permitted")):
            line = realtime.priority()
        self.assertEqual(line.verdict, WEAK)
        self.assertIn("rtprio", line.remedy)
        self.assertIn("not permitted", line.found)

    def test_memory_that_cannot_be_locked_is_weak(self):
        with mock.patch.object(realtime.resource, "getrlimit", return_value=(8 << 20, 8 << 20)), \
             mock.patch.object(realtime.os, "geteuid", return_value=1000):
            line = realtime.memory()
        self.assertEqual(line.verdict, WEAK)
        self.assertIn("8 MB", line.found)

    def test_a_small_share_of_real_time_work_is_weak(self):
        for runtime, verdict in ((-1, GOOD), (950000, GOOD), (500000, WEAK)):
            with tempfile.NamedTemporaryFile("w") as file:
                file.write(f"{runtime}\n")
                file.flush()
                self.assertEqual(realtime.share(file.name).verdict, verdict)

    def test_lateness_is_reported_by_its_order_statistics(self):
        late = [float(i) for i in range(1000)]
        random.Random(1).shuffle(late)
        with mock.patch.object(realtime, "lateness_us", return_value=late):
            line = realtime.wakeups(1, True, lambda share: None)
        self.assertEqual((line.figures["p50"], line.figures["p99"], line.figures["max"]), (500, 990, 999))
        self.assertEqual(line.verdict, WEAK)
        with mock.patch.object(realtime, "lateness_us", return_value=[x / 100 for x in late]):
            self.assertEqual(realtime.wakeups(1, True, lambda share: None).verdict, GOOD)

    def test_the_loop_ticks_a_thousand_times_a_second_and_never_early(self):
        late = realtime.lateness_us(0.2, False, lambda share: None)
        self.assertEqual(len(late), 200)
        self.assertGreaterEqual(min(late), 0)


class Devices(unittest.TestCase):
    def test_the_renderer_is_named_and_a_software_renderer_is_marked(self):
        def fails():
            raise OSError("no display can be opened")
        self.assertEqual(devices.picture(lambda: "GeForce").verdict, GOOD)
        self.assertEqual(devices.picture(lambda: "llvmpipe (LLVM)").verdict, WEAK)
        self.assertEqual(devices.picture(fails).verdict, MISSING)

    def test_the_remedy_for_a_missing_renderer_fits_the_machine(self):
        with mock.patch.object(devices.glob, "glob", return_value=[]), mock.patch.object(devices.pathlib.Path, "exists", return_value=False):
            self.assertIn("tactus setup run installs", devices.renderer_advice())
        with mock.patch.object(devices.pathlib.Path, "exists", return_value=True), mock.patch.object(devices.pathlib.Path, "is_dir", return_value=True), \
                mock.patch.dict(os.environ, {"LIBGL_DRIVERS_PATH": "/none"}, clear=True):
            self.assertEqual("a software renderer is installed; unset LIBGL_DRIVERS_PATH", devices.renderer_advice())

    def test_a_missing_sound_card_is_reported(self):
        self.assertEqual(devices.sound(False).verdict, WEAK)
        self.assertEqual(devices.sound(True).verdict, GOOD)

    def test_a_folder_that_cannot_be_written_makes_the_machine_unfit(self):
        line = devices.disk("/proc", 1)
        self.assertEqual(line.verdict, MISSING)
        self.assertTrue(line.needed)
        with tempfile.TemporaryDirectory() as folder:
            self.assertGreater(devices.disk(folder, 1).figures["MB_per_s"], 0)
            self.assertEqual(os.listdir(folder), [])


class Program(unittest.TestCase):
    def test_table_and_json_agree_and_the_exit_status_is_the_verdict(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "fit.json"
            words = [str(ROOT / "scripts" / "tactus"), "doctor", "--seconds", "0.2", "--out", folder, "--json", str(path)]
            run = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
            self.assertIn(run.returncode, (0, 1), run.stderr)
            report = json.loads(path.read_text())
        self.assertEqual(report["fit"], run.returncode == 0)
        for line in report["lines"]:
            self.assertIn(f"{line['what'] + ':':26}{line['found']}", run.stdout)
            self.assertIn(line["verdict"], (GOOD, WEAK, MISSING))
            if line["verdict"] != GOOD:
                self.assertTrue(line["remedy"], line)
        self.assertGreaterEqual(len(report["lines"]), 12)

    def test_an_unwritable_folder_and_invalid_arguments_exit_with_1(self):
        for words in (["--seconds", "0.1", "--out", "/proc"], ["--seconds", "nonsense"], ["--seconds", "0"]):
            run = subprocess.run([str(ROOT / "scripts" / "tactus"), "doctor", *words], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(run.returncode, 1, run.stdout + run.stderr)


if __name__ == "__main__":
    unittest.main()
