"""Tests of the ranking of metrics with a task left out, and of the tasks that it uses."""
import json
import pathlib
import sys
import types
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.information import degraded, estimate, pictures
from tactus.metrics import ranking, tasks


class RankingByTask(unittest.TestCase):
    def conditions(self, success):
        """Four tasks with other chances and baselines, under the same operators. success(relative of the true curve, task number)."""
        found = []
        for number, (chance, undegraded) in enumerate(((0.25, 0.95), (0.5, 0.9), (0.1, 0.8), (0.25, 0.7))):
            for operator, levels in (("delay", (20, 100, 400)), ("rate", (30, 10, 3)), ("loss", (20, 60, 90))):
                for level in levels:
                    metrics = ranking.of_condition("haptic", operator, level)
                    relative = success(1 / (1 + (metrics["age_ms"] / 100) ** 2), number)
                    found.append({"task": f"t{number}", "games": 1000, "chance": chance, "undegraded": undegraded, "success": chance + relative * (undegraded - chance), "metrics": metrics})
        return found

    def test_the_metric_on_which_success_depends_in_every_task_is_the_first(self):
        ranked = ranking.rank_by_task(self.conditions(lambda relative, task: relative))
        self.assertEqual("age_ms", ranked[0]["metric"])
        self.assertGreater(ranked[0]["explained"], 0.97)
        self.assertEqual({"t0", "t1", "t2", "t3"}, set(ranked[0]["groups"]))
        self.assertEqual(len(ranking.METRICS), len(ranked))

    def test_a_task_that_answers_otherwise_is_not_predicted(self):
        ranked = {row["metric"]: row for row in ranking.rank_by_task(self.conditions(lambda relative, task: relative if task else 1.0))}
        same = {row["metric"]: row for row in ranking.rank_by_task(self.conditions(lambda relative, task: relative))}
        self.assertGreater(ranked["age_ms"]["groups"]["t0"], same["age_ms"]["groups"]["t0"])
        self.assertLess(ranked["age_ms"]["explained"], 0.8)

    def test_success_without_any_effect_gives_the_loss_of_the_mean(self):
        for row in ranking.rank_by_task(self.conditions(lambda relative, task: 1.0)):
            self.assertAlmostEqual(0, row["skill"], delta=1e-6)

    def test_the_stored_ranking_is_that_of_its_conditions(self):
        stored = json.loads(tasks.STORED.read_text(encoding="utf-8"))
        conditions = [{**c, "metrics": ranking.of_condition(c["modality"], c["operator"], c["level"])} for c in stored["conditions"]]
        self.assertEqual(7, len({c["task"] for c in conditions}))
        for row, again in zip(stored["ranking"], ranking.rank_by_task(conditions)):
            self.assertAlmostEqual(row["loss_bits"], again["loss_bits"], delta=2e-3)  # successes are stored with four digits
        self.assertIn("tactus.metrics.tasks", stored["command"])


class Tasks(unittest.TestCase):
    def test_values_are_chosen_evenly_with_both_ends(self):
        self.assertEqual([0, 2, 5, 7], tasks.evenly(range(8), 4))
        self.assertEqual([0, 1, 2], tasks.evenly(range(3), 4))

    def test_an_observer_that_expects_undegraded_percepts_answers_by_them(self):
        # Four values, one percept with d' = 20 between neighbours: shifted by one step, every answer but the last is that of the neighbour.
        expected = [estimate.Percept("haptic", np.arange(4.0).reshape(4, 1, 1), np.full((4, 1, 1), 0.05))]
        shifted = [estimate.Percept("haptic", np.arange(4.0).reshape(4, 1, 1) + 1, np.full((4, 1, 1), 0.05))]
        right = lambda presented: estimate.Observer(expected, 400, 1, 0.0, presented=presented).result(["haptic"])["success"]
        self.assertEqual(1, right(None))
        self.assertEqual(1, right(expected))
        self.assertAlmostEqual(0.25, right(shifted), delta=1e-9)

    def test_pictures_have_the_same_distances_in_common_coordinates(self):
        options = types.SimpleNamespace(values=2, variants=1)
        task = types.SimpleNamespace(name="t", values={"a": (), "b": ()}, variants=((),))
        random = np.random.default_rng(2)
        picture = {(n, c): random.integers(0, 255, 300).tolist() for n in (0, 1) for c in ("", "rate")}
        store = {f"t|{n}|visual|{c}|{2 if c else 0}": [[values, [], 0.0]] for (n, c), values in picture.items()}
        expected, presented = tasks.seen(task, options, store, tasks.UNDEGRADED, ("rate", 2.0))
        noise = 255 * pictures.channel_sd(degraded.SIZE[0]) / degraded.SKIPPED
        for a in (0, 1):
            for b in (0, 1):
                distance = np.linalg.norm(np.array(picture[a, ""], float) - np.array(picture[b, "rate"], float)) / noise
                self.assertAlmostEqual(distance, float(np.linalg.norm(expected.mean[a, 0] - presented.mean[b, 0])), delta=1e-6 * distance)


if __name__ == "__main__":
    unittest.main()
