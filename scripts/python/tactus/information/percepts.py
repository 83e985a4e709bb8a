"""Percepts of all renderings of a task, for the ideal observer of estimate.py."""
import concurrent.futures
import pathlib

import numpy as np

from tactus.information import pictures, rendering, task_file
from tactus.information.estimate import Percept

SENSES = (*task_file.SENSES, "proprioception")


def renderings(task):
    """[(value, variant, changes)] of all combinations."""
    return [(v, e, (*changes, *variant)) for v, changes in enumerate(task.values.values()) for e, variant in enumerate(task.variants)]


def render(task, folder, size, jobs):
    """Renders every value under every variant; returns ([(features, pictures)] in the order of renderings(), warnings). Raises Refusal."""
    folder = pathlib.Path(folder)
    scenes = [task_file.changed_scene(task.scene, changes) for _, _, changes in renderings(task)]

    def one(number):
        place = folder / f"{task.name}_{number + 1}"
        warnings = rendering.render(scenes[number], task.scene.parent, place, task.seconds, size)
        return rendering.perceived(place, task.windows, size), warnings

    found, warnings = [], []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(one, i) for i in range(len(scenes))]
        try:
            for future in futures:
                perceived, said = future.result()
                found.append(perceived)
                warnings += said
        except BaseException:
            for future in futures:
                future.cancel()
            raise
    return found, list(dict.fromkeys(warnings))


def percepts(task, perceived, width):
    """[Percept] of the renderings of a task. Pictures count as far as all renderings have them."""
    values, variants = len(task.values), len(task.variants)
    table = lambda rows: np.stack(rows).reshape(values, variants, -1)
    found = []
    for key in perceived[0][0]:
        means, deviations, wrong = zip(*(features[key] for features, _ in perceived))
        found.append(Percept(key[0], table(means), table(deviations), wrong[0]))
    looks = min(len(p) for _, p in perceived)
    seen = pictures.coordinates([p[:looks] for _, p in perceived], width) if looks else np.zeros((values * variants, 1))
    found.insert(0, Percept("visual", table(seen), np.ones((values, variants, seen.shape[1]))))
    return sorted(found, key=lambda p: SENSES.index(p.sense))
