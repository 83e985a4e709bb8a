"""The simulated experiments of measure_coverage distinguish intervals that hold the truth from those that do not."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from common import coverage  # noqa: E402


class Coverage(unittest.TestCase):
    def test_percentiles_of_five_people_miss_the_truth_and_students_t_does_not(self):
        rows = {(r["truth"], r["method"].split(":")[0]): r for r in coverage.of_people(250, 1)}
        before, after = (rows["5 people: shares, Beta(9, 1), 20 games", when] for when in ("before", "after"))
        self.assertLess(before["held"], 0.9)
        self.assertLess(abs(after["held"] - 0.95), 4 * 0.0138)
        self.assertFalse(before["judged"])
        self.assertTrue(after["judged"])

    def test_the_closed_forms_of_the_limits_are_those_of_the_curves(self):
        self.assertAlmostEqual(coverage.true_limit(coverage.hill(60, 4)), 35.0370, places=2)
        self.assertAlmostEqual(coverage.true_limit(coverage.hill(60, 12)), 50.15, places=1)
        self.assertAlmostEqual(coverage.true_limit(coverage.weibull(75, 3)), 35.94, places=1)

    def test_straight_lines_between_levels_cross_where_algebra_says(self):
        import numpy as np
        shares = np.array([0.9, 0.9, 0.85, 0.75, 0.8, 0.5])  # the levels at 100 and 150 ms are pooled
        self.assertAlmostEqual(coverage.lines_crossing(shares), 50 + 50 * (0.1 - 0.05) / (0.125 - 0.05))


if __name__ == "__main__":
    unittest.main()
