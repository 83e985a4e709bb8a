#!/usr/bin/env python3
"""Tests of scripts/run: closed terminals, invalid texts, full disks and wrong arguments give results or one sentence."""
import csv
import errno
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus import terminal
from tactus.launch import arguments, cluster, main, results, services, walls
from tactus.paths import SCRIPTS
from tactus.refusal import Interrupted, Refusal

signal.signal(signal.SIGINT, signal.default_int_handler)  # main replaced it
HOSTILE = b"\xff\xfe caf\xe9 \x1b[2J"


def refusal_of(*words):
    try:
        arguments.parse(list(words), os.getcwd())
    except Refusal as refusal:
        return str(refusal)
    return ""


class Folders(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.lines, self.errors = [], []
        for what in (mock.patch.object(terminal, "report", lambda text, stream=None: self.lines.append(text)),
                     mock.patch.object(cluster, "report_error", self.errors.append), mock.patch.object(cluster, "report_run", self.lines.append),
                     mock.patch.object(main, "report_run", self.lines.append),
                     mock.patch.object(terminal, "report_error", self.errors.append)):
            what.start()
            self.addCleanup(what.stop)

    def program(self, name, text):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"#!/bin/sh\n" + text + b"\n")
        path.chmod(0o755)
        return [str(path), "--out", str(self.folder)]

    def plan(self):
        return arguments.parse(["--out", str(self.folder / "out")], os.getcwd())


class Terminal(unittest.TestCase):
    def test_a_closed_pipe_stops_only_the_output(self):
        with tempfile.TemporaryDirectory() as folder:
            done = pathlib.Path(folder) / "done"
            code = ("import sys, pathlib, subprocess; sys.path.insert(0, sys.argv[1]); from tactus import terminal; terminal.prepare()\n"
                    "for i in range(3): terminal.report_run('x' * 100000)\n"
                    "subprocess.run(['echo', 'output of a child'], check=True)\n"
                    "pathlib.Path(sys.argv[2]).touch()")
            with subprocess.Popen([sys.executable, "-c", code, str(SCRIPTS / "python"), str(done)], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE) as process:
                process.stdout.close()
                said = process.stderr.read()
            self.assertEqual((0, b"", True), (process.returncode, said, done.exists()))

    def test_control_characters_are_escaped(self):
        self.assertEqual("a\\x1b[2Jb\nc\\x9b\\x7f é", terminal.printable("a\x1b[2Jb\nc\x9b\x7f é"))

    def test_unencodable_characters_are_escaped(self):
        code = ("import sys; sys.path.insert(0, sys.argv[1]); from tactus import terminal; terminal.prepare(); terminal.report('\\udcff')")
        output = subprocess.run([sys.executable, "-c", code, str(SCRIPTS / "python")], capture_output=True, check=True).stdout
        self.assertEqual(b"\\udcff\n", output)


class Arguments(unittest.TestCase):
    def test_each_invalid_argument_is_named(self):
        for words, named in ((["--set", "../x.y=1"], "../x has no settings"), (["--set", ".x=1"], "NODE.NAME=VALUE"),
                             (["--set", "sync_node.x=1"], "sync_node has no settings"),
                             (["--set", "audio_node.device=a\nb"], "control character"), (["--out", "a\x1bb"], "control character"),
                             (["--without", "recorder"], "all results come from its log"),
                             (["--degrade", "/no/such.xml"], "/no/such.xml")):
            self.assertIn(named, refusal_of(*words))
            self.assertNotIn("\n", refusal_of(*words))

    def test_a_full_disk_is_refused_at_the_start(self):
        with mock.patch.object(os, "statvfs", return_value=types.SimpleNamespace(f_bavail=3, f_frsize=4096)):
            self.assertIn("full", refusal_of())

    def test_a_profile_goes_to_every_sense_to_sim_node_and_to_sync_node(self):
        plan = arguments.parse(["--degrade", __file__], os.getcwd())
        with_it = [name for name, words in cluster.commands(plan, 1, "").items() if "--degrade" in words]
        self.assertEqual({*plan.senses(), "sim_node", "sync_node"}, set(with_it))

    def test_a_profile_in_an_unknown_encoding_is_refused_with_one_sentence(self):
        for encoding in ("foo", "UTF-32"):
            with tempfile.NamedTemporaryFile(suffix=".xml") as file:
                file.write(f'<?xml version="1.0" encoding="{encoding}"?><profile/>'.encode())
                file.flush()
                plan = arguments.parse(["--degrade", file.name], os.getcwd())
                with self.assertRaises(Refusal) as caught:
                    arguments.unknown_modalities(plan)
                self.assertIn("save it as UTF-8", str(caught.exception))


class Hands(Folders):
    """Each tool of a scene has its own process."""

    def of(self, *tools, words=()):
        scene = self.folder / "scene.sdf"
        scene.write_text('<sdf version="1.9"><world name="w"><tactus:audio_node gain="1"/><model name="m"><tactus:tool name="no"/></model>'
                         + "".join(f'<tactus:tool name="{t}"/>' for t in tools) + "</world></sdf>", encoding="utf-8")
        plan = arguments.parse([str(scene), *words], os.getcwd())
        return plan, cluster.commands(plan, 1, "")

    @staticmethod
    def after(words, option):
        return [value for before, value in zip(words, words[1:]) if before == option]

    def test_the_first_hand_is_haptic_node_and_the_others_are_named_after_their_tools(self):
        plan, commands = self.of("left", "right hand", "right/hand")
        self.assertEqual({"haptic_node_right_hand": "right hand", "haptic_node_right_hand_3": "right/hand"}, plan.hands)
        self.assertEqual(["recorder", "sync_node", "haptic_node", *plan.hands, "audio_node", "visual_node", "thermal_node", "sim_node"],
                         plan.nodes())
        words = commands["haptic_node_right_hand"]
        self.assertEqual("haptic_node", os.path.basename(words[0]))
        self.assertEqual(["haptic_node_right_hand"], self.after(words, "--name"))
        self.assertEqual(["right hand"], self.after(words, "--tool"))
        self.assertNotIn("--name", commands["haptic_node"])

    def test_a_scene_with_at_most_one_tool_or_invalid_xml_has_one_hand(self):
        for tools in ((), ("hand",), ("<",)):
            self.assertEqual({}, self.of(*tools)[0].hands)

    def test_a_device_without_a_tool_goes_to_the_first_one(self):
        _, commands = self.of("a", "b", words=["--device", "b=playback:x.csv,rate=2", "--device", "playback:y.csv,scale=2"])
        self.assertEqual(["playback:y.csv,scale=2"], self.after(commands["haptic_node"], "--device"))
        self.assertEqual(["playback:x.csv,rate=2"], self.after(commands["haptic_node_b"], "--device"))
        _, commands = self.of("a", "b", words=["--device", "a=virtual_hand"])
        self.assertEqual(["virtual_hand"], self.after(commands["haptic_node"], "--device"))
        self.assertEqual([], self.after(commands["haptic_node_b"], "--device"))

    def test_unknown_tools_second_devices_and_shared_devices_are_refused(self):
        for words, said in ((["head=external:e"], 'no tool "head"; it has a, b'), (["b=external:e", "b=virtual_hand"], "already has a device"),
                            (["external:e", "a=external:f"], "already has a device"),
                            (["a=external:e,offset=0/0/1", "b=external:e"], "a already holds external:e")):
            with self.assertRaises(arguments.Refusal) as refused:
                self.of("a", "b", words=[w for word in words for w in ("--device", word)])
            self.assertIn(said, str(refused.exception))

    def test_every_setting_of_every_node_is_found(self):
        for node in ("sim_node", *arguments.SENSES):
            with open(SCRIPTS.parent / node / "settings.csv", encoding="utf-8", newline="") as table:
                words = [f"{row['name']}=1" for row in csv.DictReader(table)]
            self.assertGreater(len(words), 5)
            given = [each for word in words for each in ("--set", f"{node}.{word}")]
            self.assertEqual(words, arguments.parse(given, os.getcwd()).settings[node])

    def test_a_setting_of_haptic_node_applies_to_every_hand_and_is_overridden_by_its_own(self):
        _, commands = self.of("a", "b", "c", words=["--set", "haptic_node_b.force_limit=2", "--set", "haptic_node.force_limit=3"])
        self.assertEqual(["force_limit=3"], self.after(commands["haptic_node"], "--set"))
        self.assertEqual(["force_limit=3", "force_limit=2"], self.after(commands["haptic_node_b"], "--set"))
        self.assertEqual(["force_limit=3"], self.after(commands["haptic_node_c"], "--set"))

    def test_one_or_all_hands_can_be_left_out(self):
        self.assertEqual({"haptic_node_c": "c"}, self.of("a", "b", "c", words=["--without", "haptic_node_b"])[0].hands)
        plan, _ = self.of("a", "b", words=["--without", "haptic_node"])
        self.assertFalse([n for n in plan.nodes() if n.startswith("haptic")])
        self.assertIn("haptic_node_lamp", refusal_of("--without", "haptic_node_nose"))


class Walls(Folders):
    """Each wall of a room has its own process."""

    def of(self, *words):
        plan = arguments.parse(list(words), os.getcwd())
        return plan, cluster.commands(plan, 1, "")

    after = staticmethod(Hands.after)

    def test_the_first_wall_is_visual_node_and_the_others_are_named_after_their_walls(self):
        plan, commands = self.of("--room", "cave4", "--without", "haptic_node")
        drawing = ["visual_node", "visual_node_front", "visual_node_right", "visual_node_floor"]
        self.assertEqual(["recorder", "sync_node", "audio_node", *drawing, "thermal_node", "sim_node"], plan.nodes())
        for process, wall in zip(drawing, ("left", "front", "right", "floor")):
            self.assertEqual("visual_node", os.path.basename(commands[process][0]))
            self.assertEqual(["room=cave4", f"wall={wall}"], self.after(commands[process], "--set"))
            self.assertEqual([] if process == "visual_node" else [process], self.after(commands[process], "--name"))

    def test_without_a_room_there_is_one_visual_node(self):
        plan, commands = self.of()
        self.assertEqual({}, plan.walls)
        self.assertEqual([], self.after(commands["visual_node"], "--set"))

    def test_a_room_file_is_passed_as_an_absolute_path(self):
        mine = self.folder / "mine.csv"
        head = (walls.ROOMS / "desk.csv").read_text(encoding="utf-8").split("\n", maxsplit=1)[0]
        mine.write_text(head + "\neye,0,0,1,,,,,,\na/b,1,1,0,1,-1,0,1,1,2\na b,1,-1,0,-1,-1,0,1,-1,2\nc,-1,1,0,1,1,0,-1,1,2\n", encoding="utf-8")
        plan, commands = self.of("--room", os.path.relpath(mine))
        self.assertEqual({"visual_node": "a/b", "visual_node_a_b": "a b", "visual_node_c": "c"}, plan.walls)
        self.assertEqual([f"room={mine}", "wall=c"], self.after(commands["visual_node_c"], "--set"))

    def test_an_invalid_room_is_refused_with_one_sentence(self):
        (self.folder / "empty.csv").write_text("wall\n", encoding="utf-8")
        for room, said in (("cave5", "choose cave4, cave6, desk"), (str(self.folder / "empty.csv"), "has no wall"),
                           (str(self.folder), "is not a file of walls"), (__file__, "is not a file of walls")):
            self.assertIn(said, refusal_of("--room", room))

    def test_a_setting_of_visual_node_applies_to_every_wall_and_is_overridden_by_its_own(self):
        _, commands = self.of("--room", "cave4", "--set", "visual_node_floor.width=400", "--set", "visual_node.width=320", "--set", "haptic_node.force_limit=3")
        self.assertEqual(["room=cave4", "wall=left", "width=320"], self.after(commands["visual_node"], "--set"))
        self.assertEqual(["room=cave4", "wall=floor", "width=320", "width=400"], self.after(commands["visual_node_floor"], "--set"))

    def test_one_or_all_walls_can_be_left_out(self):
        plan, _ = self.of("--room", "cave4", "--without", "visual_node_floor")
        self.assertEqual(["visual_node", "visual_node_front", "visual_node_right"], [n for n in plan.nodes() if n.startswith("visual")])
        plan, _ = self.of("--room", "cave4", "--without", "visual_node")
        self.assertFalse([n for n in plan.nodes() if n.startswith("visual")])


class Shaders(Folders):
    """Shaders of a scene are reloaded from the folder of the scene after a change."""

    def words(self, world, *words):
        scene = self.folder / "scene.sdf"
        scene.write_text(f'<sdf version="1.9"><world name="w">{world}</world></sdf>', encoding="utf-8")
        commands = cluster.commands(arguments.parse([str(scene), *words], os.getcwd()), 1, "")
        return {name: [w for w in command if w.startswith("shader_folder=")] for name, command in commands.items()}

    def test_every_wall_gets_the_shader_folder_of_the_scene(self):
        said = self.words('<tactus:shader name="stripes" fragment="stripes.frag"/>', "--room", "cave4")
        there = [f"shader_folder={self.folder}"]
        self.assertEqual(there, said["visual_node"])
        self.assertEqual(there, said["visual_node_floor"])
        self.assertEqual([], said["sim_node"])

    def test_a_scene_without_shaders_or_with_its_own_folder_gets_no_setting(self):
        self.assertEqual([], self.words('<model name="m"><tactus:shader name="no"/></model>')["visual_node"])
        self.assertEqual([], self.words('<tactus:shader name="s"/><tactus:visual_node shader_folder="/x"/>')["visual_node"])

    def test_a_requested_shader_folder_overrides_that_of_the_scene(self):
        said = self.words('<tactus:shader name="s"/>', "--set", "visual_node.shader_folder=/x")["visual_node"]
        self.assertEqual([f"shader_folder={self.folder}", "shader_folder=/x"], said)


class Checks(Folders):
    def check(self, stop=False, **programs):
        cluster.check({name: self.program(name, text) for name, text in programs.items()}, types.SimpleNamespace(requested=stop))

    def test_a_refusal_of_invalid_bytes_is_still_one_sentence(self):
        (self.folder / "hostile").write_bytes(HOSTILE)
        with self.assertRaises(Refusal) as caught:
            self.check(sim_node=b"cat %s/hostile >&2; exit 1" % bytes(self.folder))
        self.assertIn("caf", str(caught.exception))

    def test_warnings_of_a_valid_scene_are_printed(self):
        self.check(sim_node=b"echo odd >&2", audio_node=b"")
        self.assertEqual(["odd"], self.errors)

    def test_ctrl_c_is_no_error_of_a_node(self):
        with self.assertRaises(Interrupted):
            self.check(stop=True, visual_node=b"kill -INT $$", sim_node=b"exec sleep 60")

    def test_a_large_scene_is_awaited(self):
        with mock.patch.object(cluster, "PROGRESS_S", 0.15):
            self.check(sim_node=b"sleep 0.5")
        self.assertIn("still reading the scene", self.lines[0])


class TakenDown(Folders):
    def service(self, stat):
        (self.folder / "services").mkdir()
        service = services.Service(self.folder, "haptic_node", ["true"], self.folder / "log", self.folder)
        (service.path / "supervise").mkdir()
        (service.path / "supervise" / "stat").write_text(stat, encoding="utf-8")
        return service

    def test_only_a_stopped_service_is_taken_down(self):
        for stat, taken in (("down\n", True), ("down, normally up\n", True), ("down, want up\n", False), ("run, normally down\n", False),
                            ("finish\n", False)):
            with tempfile.TemporaryDirectory() as folder:
                self.folder = pathlib.Path(folder)
                service = self.service(stat)
                self.assertEqual(taken, service.is_stopped_by_user(), stat)
                (service.path / "lost").write_text("left down", encoding="utf-8")
                self.assertFalse(service.is_stopped_by_user(), stat)


class Results(Folders):
    def test_a_folder_in_use_is_refused(self):
        plan = self.plan()
        claim = main.claim_out(plan)
        with self.assertRaises(Refusal) as caught:
            main.claim_out(self.plan())
        self.assertIn("another run is writing", str(caught.exception))
        os.close(claim)
        os.close(main.claim_out(self.plan()))

    def test_a_full_disk_is_refused_with_one_sentence_and_leaves_no_folder(self):
        plan = self.plan()
        plan.out.mkdir()
        full = OSError(errno.ENOSPC, "No space left on device", "/tmp/x")
        with mock.patch.object(services, "Service", side_effect=full), mock.patch.object(tempfile, "tempdir", str(self.folder)):
            with self.assertRaises(Refusal) as caught:
                cluster.Cluster(plan, None, {"recorder": []}, 1)
        self.assertIn("No space left on device", str(caught.exception))
        self.assertEqual([], list(self.folder.glob("tactus-*")))

    def test_a_system_error_is_reported_with_one_sentence(self):
        with mock.patch.object(main, "run", side_effect=OSError(errno.ENOSPC, "No space left on device", "/x")):
            self.assertEqual(1, main.main([]))
        self.assertEqual(["run: /x: No space left on device"], self.errors)

    def test_all_results_are_written_before_any_is_printed(self):
        plan = self.plan()
        plan.out.mkdir()
        (plan.out / "run.lcmlog").touch()
        (self.folder / "hostile").write_bytes(HOSTILE)
        for name in ("summarise", "export_csv", "export_events"):
            self.program(name, b"cat %s/hostile; touch %s/out/$(basename $0)" % (bytes(self.folder), bytes(self.folder)))
        made_when_reported = []
        with mock.patch.object(results, "BIN", self.folder / "bin"), \
                mock.patch.object(terminal, "report", lambda text: made_when_reported.extend(p.name for p in plan.out.iterdir())):
            self.assertEqual([], main.summarise(plan, "git", {}, {}, ["a warning"]))
        self.assertLessEqual({"summarise", "export_csv", "export_events"}, set(made_when_reported))


class Programs(unittest.TestCase):
    def test_scripts_build_builds_all_programs_of_a_run_and_a_study(self):
        from tactus.launch import virtual
        text = (SCRIPTS / "build").read_text(encoding="utf-8")
        built = [name for part in ("run_targets=(", '("${run_targets[@]}" ') for name in text.partition(part)[2].partition(")")[0].split()]
        for program in (*arguments.SENSES, *virtual.PROGRAMS, arguments.PLAYER_PROGRAM, "trial_runner", "play_games"):
            self.assertIn(program, built)


if __name__ == "__main__":
    unittest.main()
