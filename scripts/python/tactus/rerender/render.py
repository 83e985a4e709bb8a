"""One sense of a log, rendered by its node into a folder."""
import os
import re
import subprocess

# What each sense is rendered by and into; the files are called as in the folder of a run.
SENSES = {
    "haptic": ("haptic_node", "--trace", "haptic.csv"),
    "audio": ("audio_node", "--wav", "audio.wav"),
    "visual": ("visual_node", "--video", "video.mp4"),
    "thermal": ("thermal_node", "--trace", "thermal.csv"),
}
OF_A_TOOL = ("haptic", "thermal")


class Refused(Exception):
    """One sentence of the node on why it rendered nothing."""


def command(programs, sense, log, folder, profile, tool, settings):
    """profile: a file, "logged", or None; settings: {sense: [name=value]}."""
    node, output, name = SENSES[sense]
    words = [os.path.join(programs, node), "--log", log, output, os.path.join(folder, name),
             "--presented", os.path.join(folder, f"presented_{sense}.csv")]
    if sense == "visual":
        words += ["--frames", os.path.join(folder, "frames.csv")]
    if profile:
        words += ["--degrade", profile]
    if tool and sense in OF_A_TOOL:
        words += ["--tool", tool]
    for setting in settings.get(sense, []):
        words += ["--set", setting]
    return words


def render(words, tell):
    """What the node says when it is done, line by line. tell: is handed the share of the log, in %."""
    said = []
    with subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, errors="replace") as node:
        try:
            for line in node.stderr:
                share = re.search(r": (\d+) % of the log$", line.rstrip())
                if share:
                    tell(int(share.group(1)))
                else:
                    said.append(line.rstrip())
        except BaseException:
            node.terminate()
            raise
    if node.returncode != 0:
        raise Refused(said[-1] if said else f"{words[0]} ended with {node.returncode} and said nothing")
    return said


def figure(said, pattern):
    """The number that a line of a node tells, or None."""
    for line in reversed(said):
        found = re.search(pattern, line)
        if found:
            return float(found.group(1))
    return None


def facts(said):
    """How long was rendered how fast, and when the first sample of sound was out, as the node says."""
    return {"took_s": figure(said, r" in ([\d.e+-]+) s \("), "times_as_fast_as_time": figure(said, r"\(([\d.e+-]+) times as fast"),
            "first_sample_ns": next((int(m.group(1)) for m in (re.search(r"first sample was out at (\d+) ns", line) for line in said) if m), None)}
