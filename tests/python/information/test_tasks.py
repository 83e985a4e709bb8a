"""Tests that every shipped task needs the senses that it names, and falls to chance without them: rendered in virtual time, with few draws."""
import dataclasses
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))

from tactus.information import main, noise, percepts, rendering, task_file  # noqa: E402
from tactus.information.estimate import Observer  # noqa: E402

DRAWS = 600
SIZE = (320, 240)
# Variants that are rendered. More than one where a variant hides a cue of another sense: the force of a press, the loudness of a tap.
VARIANTS = {"stiffness_by_touch": 3, "material_by_sound_and_warmth": 3}
# Bits that the other senses may carry about the variable. In the tap on a plate, the vibration is a part of the information of the sound.
LEFT_BITS = {"material_by_sound_and_warmth": 0.4}


class Tasks(unittest.TestCase):
    def observer(self, name):
        """A task, and its ideal observer."""
        rendering.require_programs()
        task = task_file.read(name)
        task = dataclasses.replace(task, variants=task.variants[:VARIANTS.get(name, 1)])
        with tempfile.TemporaryDirectory() as folder:
            perceived, warnings = percepts.render(task, folder, SIZE, len(os.sched_getaffinity(0)))
        self.assertEqual([], warnings, name)
        return task, Observer(percepts.percepts(task, perceived, SIZE[0]), DRAWS, lapse=noise.values()["lapse"])

    def check(self, name):
        task, observer = self.observer(name)
        for sense in task.senses:
            self.assertTrue(main.holds(observer.gain(sense)), (name, sense, observer.gain(sense)))
        rest = observer.result([s for s in observer.senses if s not in task.senses])
        self.assertLess(rest["bits"], LEFT_BITS.get(name, 0.05), name)
        self.assertLess(rest["bits"], observer.result(observer.senses)["bits"] / 3, name)
        if name not in LEFT_BITS:
            chance = 1 / len(task.values)
            self.assertLess(rest["success"], chance + 4 * (chance * (1 - chance) / DRAWS)**0.5 + 0.05, name)


def add(name):
    setattr(Tasks, f"test_{name}", lambda self: self.check(name))


for shipped in task_file.shipped():
    add(shipped)

if __name__ == "__main__":
    unittest.main()
