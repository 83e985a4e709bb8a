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
from tactus.battery import answers, perceivers
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
    def test_the_conditions_of_a_task_are_those_of_the_typical_naive_player(self):
        """A sound whose direction carries two values, and which a degradation removes."""
        class Silent:
            task = types.SimpleNamespace(name="t", senses=("audio",), values={"left": (), "right": ()})
            shape = (2, 1)

            def features(self, sense, condition, seed):
                heard = np.full((2, 1, 1), 0.0 if condition.operator else 1.0)
                return np.concatenate([heard, np.array([-60.0, 60.0]).reshape(2, 1, 1)], axis=2), np.ones((2, 1, 2))

            def columns(self, sense):
                return np.array([0, 1]), np.array(["heard", "direction"]), np.zeros(2)
        found = tasks.conditions_of(answers.Parts(Silent()), 4000, 1)
        self.assertEqual({"delay", "jitter", "loss", "rate"}, {c["operator"] for c in found})
        for c in found:
            self.assertAlmostEqual(1 - perceivers.TYPICAL.lapse / 2, c["undegraded"], delta=0.01)
            self.assertAlmostEqual(0.5, c["success"], delta=0.03)
            self.assertEqual((0.5, 4000), (c["chance"], c["games"]))
            self.assertEqual(set(ranking.METRICS), set(c["metrics"]))


if __name__ == "__main__":
    unittest.main()
