"""The falsifier of a lag of warmth: traces of a plate that follows, or does not follow, a first-order system."""
import pathlib
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.metrics import thermal_lag

TIME = np.arange(0, 6, 0.02)
TOUCHED = ((TIME >= 1) & (TIME < 2.5)) | ((TIME >= 4) & (TIME < 5.5))
PLAIN = np.where(TOUCHED, 28.0, 33.0)


def follows(lag_s):
    """The plate of a first-order system whose input is PLAIN."""
    found = [33.0]
    for target in PLAIN[1:]:
        found.append(target + (found[-1] - target) * np.exp(-0.02 / lag_s))
    return np.array(found)


class ThermalLag(unittest.TestCase):
    def test_a_first_order_plate_holds_for_all_time_constants(self):
        for lag_s in (0.1, 0.5, 1.0):
            rows = thermal_lag.choices((TIME, PLAIN, TOUCHED), follows(lag_s), lag_s)
            self.assertEqual([row["touch"] for row in rows], [1, 2])
            self.assertTrue(all(row["holds"] for row in rows), rows)
            self.assertAlmostEqual(rows[0]["measured_s"], lag_s * np.log(2), delta=0.021)

    def test_a_plate_that_is_slower_or_never_arrives_refutes(self):
        for plate in (follows(1.0), np.full(len(TIME), 33.0)):
            rows = thermal_lag.choices((TIME, PLAIN, TOUCHED), plate, 0.3)
            self.assertTrue(rows and not any(row["holds"] for row in rows), rows)

    def test_a_touch_that_is_too_short_for_a_choice_does_not_count(self):
        self.assertEqual(thermal_lag.choices((TIME, PLAIN, TOUCHED), follows(9.0), 9.0), [])
        rest = np.full(len(TIME), 33.0)
        self.assertEqual(thermal_lag.choices((TIME, rest, TOUCHED), rest, 0.5), [])

    def test_touches_begin_and_end_with_the_contact(self):
        self.assertEqual([tuple(np.round(TIME[list(t)], 2)) for t in thermal_lag.touches(TOUCHED)], [(1.0, 2.48), (4.0, 5.48)])
        self.assertEqual(thermal_lag.touches(np.array([True, True])), [(0, 1)])
        self.assertEqual(thermal_lag.touches(np.array([False])), [])


if __name__ == "__main__":
    unittest.main()
