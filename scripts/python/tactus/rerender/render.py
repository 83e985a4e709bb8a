"""Renders one modality of a log into a folder by calling its node."""
import os
import re
import subprocess

# {modality: (program, option, file)}; file names as in the folder of a run.
SENSES = {
    "haptic": ("haptic_node", "--trace", "haptic.csv"),
    "audio": ("audio_node", "--wav", "audio.wav"),
    "visual": ("visual_node", "--video", "video.mp4"),
    "thermal": ("thermal_node", "--trace", "thermal.csv"),
}
PER_TOOL = ("haptic", "thermal")


class Refused(Exception):
    """The node failed; its last message."""


def command(programs, sense, log, folder, profile, tool, settings, run="1"):
    """The command line of a node. profile: a file, "logged", or None; settings: {modality: [name=value]}; run: its number in the log."""
    node, output, name = SENSES[sense]
    words = [os.path.join(programs, node), "--log", log, output, os.path.join(folder, name),
             "--presented", os.path.join(folder, f"presented_{sense}.csv")]
    if sense == "visual":
        words += ["--frames", os.path.join(folder, "frames.csv")]
    if run != "1":
        words += ["--run", run]
    if profile:
        words += ["--degrade", profile]
    if tool and sense in PER_TOOL:
        words += ["--tool", tool]
    for setting in settings.get(sense, []):
        words += ["--set", setting]
    return words


def render(words, report_progress):
    """Runs a node; returns its lines of output. Calls report_progress(share of the log in %). Raises Refused."""
    output = []
    with subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, errors="replace") as node:
        try:
            for line in node.stderr:
                share = re.search(r": (\d+) % of the log$", line.rstrip())
                if share:
                    report_progress(int(share.group(1)))
                else:
                    output.append(line.rstrip())
        except BaseException:
            node.terminate()
            raise
    if node.returncode != 0:
        raise Refused(output[-1] if output else f"{words[0]} ended with status {node.returncode} without a message")
    return output


def figure(output, pattern):
    """The number in the last line that matches, or None."""
    for line in reversed(output):
        found = re.search(pattern, line)
        if found:
            return float(found.group(1))
    return None


def facts(output):
    """Duration and speed of a rendering, and the output time of the first sound sample, from the output of the node."""
    return {"took_s": figure(output, r" in ([\d.e+-]+) s \("), "times_as_fast_as_time": figure(output, r"\(([\d.e+-]+) times as fast"),
            "first_sample_ns": next((int(m.group(1)) for m in (re.search(r"first sample was out at (\d+) ns", line) for line in output) if m), None)}
