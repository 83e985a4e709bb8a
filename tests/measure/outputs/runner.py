"""Runs all steps of a case into a folder."""
import json
import os
import subprocess

from . import cases

LONGEST_S = 600  # of one program


class Failed(Exception):
    """One sentence on a program that did not end well."""


class Build:
    """The programs of one folder, the checkout with their scenes, and their start options."""

    def __init__(self, folder, root, changes, choice, instructions, variables, settings):
        self.folder, self.root, self.changes = os.path.abspath(folder), os.path.abspath(root), changes
        self.choice, self.instructions, self.variables, self.settings = choice, instructions, variables, settings
        self.helps = {}

    def help_of(self, front):
        """The output of a program with --help."""
        if tuple(front) not in self.helps:
            done = subprocess.run([*front, "--help"], capture_output=True, text=True, errors="replace", env=self.variables, check=False)
            self.helps[tuple(front)] = done.stdout + done.stderr
        return self.helps[tuple(front)]

    def words(self, command):
        return self.changes.words(self.folder, command, self.help_of)

    def run(self, case, folder):
        """All artefacts of the case, into its folder. Raises Failed."""
        for name in ("logs", "run", "tables", "wide", "clean", "degraded", *(["logged"] if case.profile else []),
                     *(["instructions"] if case.each_instructions else []), *(["games"] if case.player else [])):
            os.makedirs(os.path.join(folder, name))
        if case.log:
            os.symlink(case.log, os.path.join(folder, "run", "run.lcmlog"))
        else:
            plan = cases.plan(case, self.root, self.settings)
            with open(os.path.join(folder, "logs", "plan.json"), "w", encoding="utf-8") as file:
                # virtual_time takes the last part of a program's path, so that a plan holds no folder.
                json.dump({name: self.planned(words) for name, words in plan.items()}, file, indent=1)
        for name, command in cases.steps(case, self.root, self.settings, self.instructions):
            self.step(case, name, self.words(command), folder)

    def planned(self, command):
        words = self.words(command)
        return [os.path.basename(words[0]), *words[1:]]

    def step(self, case, name, words, folder):
        log = os.path.join(folder, "logs", f"{name}.log")
        given = cases.games() if name == "games" else ""
        output = os.path.join(folder, "games", "games.jsonl") if name == "games" else os.devnull
        with open(log, "w", encoding="utf-8") as errors, open(output, "w", encoding="utf-8") as printed:
            print(" ".join(words), file=errors, flush=True)
            try:
                done = subprocess.run(words, input=given, stdout=printed, stderr=errors, text=True, env=self.variables, cwd=folder,
                                      timeout=LONGEST_S, check=False)
            except OSError as error:
                raise Failed(f"{case.name}: {name}: cannot start {words[0]}: {error.strerror}; give --bin a folder with all programs") from None
            except subprocess.TimeoutExpired:
                raise Failed(f"{case.name}: {name}: runs for more than {LONGEST_S} s; see {log}") from None
        if done.returncode != 0:
            with open(log, encoding="utf-8", errors="replace") as file:
                last = file.read().strip().split("\n")[-1]
            raise Failed(f"{case.name}: {name}: ended with status {done.returncode} ({last})")
