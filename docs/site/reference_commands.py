"""Reference page of the command line: --help of every command of tactus, of their verbs, and of every program of the build."""
import concurrent.futures
import os
import re
import subprocess
import sys

from page_text import PageError

# Verbs that have a help of their own.
VERBS = {"study": ("check", "run", "sweep", "analyse", "replicate", "information"), "live": ("open", "follow")}
# Programs whose help is part of the page: the nodes, and the programs that a user starts directly.
PROGRAMS = ("sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "sync_node", "recorder", "replay", "relay", "spy", "summarise", "export_log",
            "virtual_time", "simulated_player", "trial_runner", "live_server", "save_pictures")


def help_of(words):
    done = subprocess.run([*words, "--help"], capture_output=True, text=True, check=False, timeout=120, stdin=subprocess.DEVNULL,
                          env={**os.environ, "COLUMNS": "120", "LC_ALL": "C.UTF-8", "TACTUS_BIN": "/nonexistent"})
    if done.returncode != 0:
        raise PageError(f"{' '.join(map(str, words))} --help exits with {done.returncode}: {done.stderr.strip()[:200]}; correct its help")
    return done.stdout.rstrip()


def anchor(text):
    return re.sub(r"[^a-z0-9_-]", "", text.lower().replace(" ", "-"))


def pages(root, programs):
    sys.path.insert(0, str(root / "scripts" / "python"))
    from tactus.commands.table import GROUPS
    tactus = root / "scripts" / "tactus"
    asked = [(c.name, *verb) for commands in GROUPS.values() for c in commands for verb in [(), *((v,) for v in VERBS.get(c.name, ()))]]
    built = [name for name in PROGRAMS if (programs / name).exists()]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        texts = dict(zip(asked, pool.map(lambda words: help_of([tactus, *words]), asked)))
        helps = dict(zip(built, pool.map(lambda name: help_of([programs / name]), built)))
    lines = ["# Command line\n", "The output of `--help` of every command. `tactus` is `scripts/tactus` of a clone, or the command of the package. Commands exit with 0, or with 1 and one "
             "sentence that names the fault and the remedy.\n"]
    for group, commands in GROUPS.items():
        lines += [f"## {group}\n", "| command | does |\n|---|---|"]
        lines += [f"| [`tactus {c.name}`](#{anchor('tactus ' + c.name)}) | {c.summary} |" for c in commands]
        lines.append("")
        for words, text in texts.items():
            if words[0] in {c.name for c in commands}:
                lines += [f"### tactus {' '.join(words)}\n", f"```text\n{text}\n```\n"]
    if helps:
        lines += ["## Programs of the build\n", "`tactus run` starts them; start one by itself to use it in another system.\n"]
        for name, text in helps.items():
            lines += [f"### {name}\n", f"```text\n{text.replace(str(root), '.')}\n```\n"]
    return {"command_line.md": "\n".join(lines)}
