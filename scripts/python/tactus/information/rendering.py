"""Renders a scene in virtual time: one run of all nodes in one process, then the pictures of its log."""
import json
import os
import re
import subprocess

import numpy as np

from tactus import environment
from tactus.information import pictures, sound, touch
from tactus.log.sound_onsets import clock_of
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal, reason_of
from tactus.tables import read_rows

NODES = ("haptic_node", "audio_node", "visual_node", "thermal_node")
PROGRAMS = ("virtual_time", "sim_node", "recorder", "sync_node", *NODES, "export_csv", "export_events")
LIMIT_S = 600  # of one program; design
WARNING = re.compile(r"sim_node: .*:\d+: /sdf")  # of the scene: file, line and path


def require_programs():
    """Raises Refusal when a program is missing."""
    for name in PROGRAMS:
        if not os.access(BIN / name, os.X_OK):
            raise Refusal(f"{BIN / name} is missing; {remedy()}")


def output(words):
    """Standard error of a program. Raises Refusal with its last line when it fails."""
    try:
        done = subprocess.run([str(w) for w in words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace",
                              check=False, timeout=LIMIT_S, env=environment.for_called())
    except subprocess.TimeoutExpired:
        raise Refusal(f"{os.path.basename(words[0])} took more than {LIMIT_S} s; shorten the task") from None
    if done.returncode != 0:
        raise Refusal(reason_of(done.stderr or done.stdout) or f"{os.path.basename(words[0])} ended with status {done.returncode} without a message")
    return done.stderr


def plan(scene, folder, scene_folder, seed):
    """{name: command line} of the nodes, as in a live run, but without pictures."""
    common = ["--run-id", "1", "--seed", str(seed), "--realtime", "off", "--out", str(folder)]
    words = {"recorder": ["recorder", "--scene", str(scene), *common], "sync_node": ["sync_node", *common]}
    words.update({node: [node, *common] for node in NODES})
    words["audio_node"] += ["--audio-device", "virtual"]
    words["visual_node"] += ["--no-pictures"]
    awaited = [w for name in words for w in ("--await", name)]
    words["sim_node"] = ["sim_node", str(scene), "--scene-folder", str(scene_folder), *awaited, *common]
    return words


def simulate(scene_xml, scene_folder, folder, seconds, seed=1):
    """Writes the log of `seconds` of a scene, run.lcmlog, into a folder. Returns the standard error. Raises Refusal."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    scene = folder / "scene.sdf"
    scene.write_bytes(scene_xml)
    plan_file = folder / "plan.json"
    plan_file.write_text(json.dumps(plan(scene, folder, scene_folder, seed)) + "\n", encoding="utf-8")
    return output([BIN / "virtual_time", plan_file, "--seconds", f"{seconds:g}", "--seed", str(seed)])


def render(scene_xml, scene_folder, folder, seconds, size, seed=1):
    """Writes log, sound, tables and pictures of `seconds` of a scene into a folder. size: (width, height) of the pictures. Returns the warnings of sim_node.
    Raises Refusal."""
    said = simulate(scene_xml, scene_folder, folder, seconds, seed)
    log = folder / "run.lcmlog"
    for exporter in ("export_csv", "export_events"):
        output([BIN / exporter, log, "--out", folder])
    output([BIN / "visual_node", "--log", log, "--video", folder / "video.mp4", "--frames", folder / "frames.csv",
            *(w for setting in picture_settings(size) for w in ("--set", setting))])
    return [line for line in said.splitlines() if WARNING.match(line)]


def picture_settings(size):
    """[name=value] of the settings of visual_node. size: (width, height)."""
    settings = {"rate": f"{pictures.LOOKS_HZ}Hz", "width": size[0], "height": size[1], "event_marker": "off", "video_crf": 0, "quality": 0}
    return [f"{name}={value}" for name, value in settings.items()]


def perceived(folder, windows, size):
    """(features, pictures) of a rendering: {(sense, name, window): (values, standard deviations, confused share)}, and the bytes of its looks."""
    felt = touch.Touch(folder / "haptic.csv")
    offset = felt.offset_ns()
    warm = touch.Warmth(folder / "thermal.csv", offset)
    clock = clock_of(read_rows(folder / "media_clock.csv"), "audio.wav")
    found = {}
    for i, (begin, end) in enumerate(windows):
        heard = sound.read(folder / "audio.wav", clock, offset + begin * 1e9, offset + end * 1e9)
        for sense, features in (("audio", sound.features(heard)), ("haptic", felt.features(begin, end)), ("thermal", warm.features(begin, end)),
                                ("proprioception", felt.hand(begin, end))):
            for name, values, deviations, wrong in features:
                found[sense, name, i] = np.array(values), np.array(deviations), wrong
    begin, end = min(w[0] for w in windows), max(w[1] for w in windows)
    return found, pictures.read(folder / "video.mp4", folder / "frames.csv", *size, offset + begin * 1e9, offset + end * 1e9)
