"""Which property of a simulated player decides: correlations of players whose games are known."""
import pathlib
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus import players
from tactus.analysis import sensitivity
from tactus.refusal import Refusal


def game(number, modality, success, operator="delay", second="", population=1, missed=0):
    return {"player": f"observer:{number} of population {population}, 20 actions of practice", "modality_degraded": modality, "operator": operator, "second_modality": second,
            "success": success, "missed": missed}


class Sensitivity(unittest.TestCase):
    def test_the_property_that_decides_is_found_and_others_are_not(self):
        rng = np.random.default_rng(3)
        values = {name: rng.lognormal(size=120) for name in ("pace", "noise", "caution", "mass")}
        outcome = np.exp(2 * np.log(values["pace"])) * rng.lognormal(sigma=0.3, size=120)  # monotone, not linear
        rows = sensitivity.table(values, {"visual": outcome, "audio": rng.normal(size=120)})
        first = rows[0]
        self.assertEqual((first["group"], first["property"]), ("visual", "pace"))
        self.assertGreater(first["share"], 0.9)
        self.assertTrue(first["low"] < first["correlation"] < first["high"])
        self.assertEqual([row["property"] for row in rows if row["p"] < 0.05], ["pace"])

    def test_properties_of_chance_are_named_in_five_of_a_hundred_populations(self):
        rng, named = np.random.default_rng(4), 0
        for _ in range(300):
            rows = sensitivity.table({str(i): rng.normal(size=30) for i in range(10)}, {"visual": rng.integers(0, 5, 30)})
            named += any(row["p"] < 0.05 for row in rows)
        self.assertTrue(2 <= named <= 27, named)  # 15 expected, standard deviation 3.8

    def test_the_intervals_of_a_correlation_hold_its_truth(self):
        rng, held = np.random.default_rng(5), 0
        truth = 6 / np.pi * np.arcsin(0.6 / 2)  # Spearman's of a bivariate normal with Pearson's 0.6 (Pearson 1907)
        for _ in range(200):
            x = rng.normal(size=100)
            row, = sensitivity.table({"x": x}, {"y": 0.6 * x + 0.8 * rng.normal(size=100)})
            held += row["low"] <= truth <= row["high"]
        self.assertTrue(178 <= held <= 200, held)  # 190 expected, standard deviation 3.1

    def test_the_properties_of_players_are_read_by_name_with_commas_in_them(self):
        found = players.properties(1, [0, 5])
        self.assertIn("motor noise, share [1]", found)
        self.assertEqual({len(values) for values in found.values()}, {2})
        self.assertTrue(all(0 <= v <= 4 for v in found["search spread [1]"]), found["search spread [1]"])  # the last column: none is shifted

    def test_shares_are_of_each_degraded_sense_and_of_players_that_played_all(self):
        rows = [game(n, m, success) for n in range(25) for m in ("visual", "haptic:percept") for success in (0, n % 2)]
        rows += [game(99, "visual", 1), game(0, "visual", 1, "off"), game(0, "visual", 1, second="haptic"), game(0, "visual", 1, second="audio"), game(0, "visual", 1, missed=1)]
        population, numbers, shares = sensitivity.shares(rows)
        self.assertEqual((population, numbers), (1, list(range(25))))
        self.assertEqual(set(shares), {"visual", "haptic:percept", "all degraded"})
        np.testing.assert_allclose(shares["visual"], [n % 2 / 2 for n in range(25)])
        _, _, shares = sensitivity.shares(rows + [game(n, "", 1, "") for n in range(25)])
        np.testing.assert_allclose(shares["undegraded"], np.ones(25))
        np.testing.assert_allclose(shares["all degraded"], [n % 2 / 2 for n in range(25)])
        missed = [row if i else {**row, "missed": 1} for i, row in enumerate(rows)]
        self.assertEqual(sensitivity.shares(missed)[1], list(range(1, 25)))  # player 0 lacks a level

    def test_outcomes_and_properties_that_hardly_vary_give_no_number_that_is_not_finite(self):
        rng = np.random.default_rng(8)
        outcome = np.zeros(60)
        outcome[:3] = 1
        values = {"same": np.ones(60), "first": np.arange(60.0), "chance": rng.normal(size=60)}
        rows = sensitivity.table(values, {"rare": outcome, "never": np.zeros(60)})
        self.assertTrue(all(np.isfinite(v) for row in rows for v in row.values() if not isinstance(v, str)), rows)
        self.assertEqual(rows[0]["property"], "first")

    def test_games_without_enough_players_of_one_population_are_refused(self):
        for rows, reason in (([game(n, "visual", 1) for n in range(19)], "needs 20"),
                             ([game(n, "visual", 1, population=n % 2) for n in range(40)], "several populations"),
                             ([{**game(1, "visual", 1), "player": "stage_model"}], "no player of a population")):
            with self.assertRaisesRegex(Refusal, reason):
                sensitivity.shares(rows)


if __name__ == "__main__":
    unittest.main()
