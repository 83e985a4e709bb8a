"""Renders the tasks under every condition, and keeps the features of the renderings in a folder, so that a stopped run continues
with the scenes that are left.

One file TASK_NUMBER.npz holds the features of one value and variant of a task: undegraded, and under each condition and draw, for each sense that the task is for. All
players have the same renderings; their noise is added later (perceivers.py).
"""
import concurrent.futures
import hashlib
import os
import pathlib
import tempfile
import zipfile
import zlib

import numpy as np

from tactus import terminal
from tactus.battery import conditions
from tactus.information import degraded, percepts, rendering, task_file
from tactus.refusal import Refusal

VERSION = 2          # of the features
DRAWS_OF_ONE = 1000  # seeds of one rendering; design: more than conditions.SEEDS


def key(sense, condition, seed):
    return f"{sense}|{condition.operator}|{condition.level:g}|{seed}"


def wanted(task):
    """[(sense, condition, seed)] of the renderings of each value and variant."""
    return [(sense, condition, seed) for sense in task.senses for condition in (conditions.UNDEGRADED, *conditions.of(sense)) for seed in condition.seeds]


def packed(sense, found):
    """Arrays of the features of a rendering: pixels as bytes; else values, standard deviations, confused shares and names by component."""
    if sense == "visual":
        return {"": np.array(found[0][0], np.uint8)}
    count = [len(values) for values, _, _, _ in found]
    return {"": np.array([sum((list(values) for values, _, _, _ in found), []), sum((list(sds) for _, sds, _, _ in found), [])]),
            "#wrong": np.repeat([wrong for _, _, wrong, _ in found], count), "#feature": np.repeat(np.arange(len(found)), count),
            "#name": np.repeat([name for _, _, _, name in found], count)}


def render(task, number, changes, folder):
    """Writes the file of one value and variant, unless it is there. Raises Refusal."""
    path = pathlib.Path(folder) / f"{task.name}_{number}.npz"
    scene = task_file.changed_scene(task.scene, changes)
    arrays = stored(path, origin(task, scene))
    left = [one for one in wanted(task) if key(*one) not in arrays]
    if not left:
        return
    with tempfile.TemporaryDirectory() as scratch:
        place = pathlib.Path(scratch) / "run"
        rendering.simulate(scene, task.scene.parent, place, task.seconds)
        log = place / "run.lcmlog"
        offset_ns = degraded.host_offset_ns(log, scratch)
        for sense, condition, seed in left:
            found = degraded.rendered(task, sense, log, conditions.element(sense, condition, seed), DRAWS_OF_ONE * number + seed, offset_ns)
            for name, array in packed(sense, found).items():
                arrays[name and sense + name or key(sense, condition, seed)] = array
    part = path.with_suffix(".part")
    with open(part, "wb") as file:
        np.savez_compressed(file, **{**arrays, "origin": origin(task, scene)})
    os.replace(part, path)


def origin(task, scene):
    """Identity of the renderings of a scene: the XML of the scene, the times of the task, and the version of the features. Files that the scene names, and the programs, are not in it."""
    return hashlib.sha256(repr((VERSION, scene, task.seconds, task.windows, task.senses)).encode()).hexdigest()


def stored(path, of):
    """The arrays of a file by name; none when it is missing, damaged or of another origin."""
    try:
        with np.load(path) as file:
            return {name: file[name] for name in file.files} if "origin" in file.files and str(file["origin"]) == of else {}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error):
        return {}


def render_all(tasks, folder, jobs):
    """Renders every value under every variant of all tasks. Raises Refusal."""
    os.makedirs(folder, mode=0o700, exist_ok=True)
    work = [(task, number, changes) for task in tasks for number, (_, _, changes) in enumerate(percepts.renderings(task))]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = [pool.submit(render, task, number, changes, folder) for task, number, changes in work]
        try:
            for done, future in enumerate(concurrent.futures.as_completed(running), 1):
                future.result()
                if done % 10 == 0 or done == len(work):
                    terminal.report_error(f"study battery: {done} of {len(work)} scenes are rendered")
        except BaseException:
            for future in running:
                future.cancel()
            raise


class Stored:
    """The features of all values and variants of a task. features(): arrays [value, variant, component]."""

    def __init__(self, task, folder):
        self.task = task
        self.shape = (len(task.values), len(task.variants))
        self.files = []
        for number, (_, _, changes) in enumerate(percepts.renderings(task)):
            path = pathlib.Path(folder) / f"{task.name}_{number}.npz"
            self.files.append(stored(path, origin(task, task_file.changed_scene(task.scene, changes))))
            if not {key(*one) for one in wanted(task)} <= set(self.files[-1]):
                raise Refusal(f"{path}: does not hold all renderings of this version; remove it, and repeat the command")

    def features(self, sense, condition, seed):
        """(values, standard deviations) of a sense that has features."""
        both = np.stack([file[key(sense, condition, seed)] for file in self.files], axis=1)
        return tuple(part.reshape(*self.shape, -1) for part in both)

    def columns(self, sense):
        """(number of the feature, its name, confused share) of each component."""
        return tuple(self.files[0][f"{sense}#{name}"] for name in ("feature", "name", "wrong"))

    def pixels(self, condition, seed):
        """[pixels] of all values and variants, in order."""
        return [file[key("visual", condition, seed)] for file in self.files]
