"""Tests of measure_modes --check, which refuses missing modes and wrong frequencies, dampings and nodal lines."""
import importlib.machinery
import importlib.util
import os
import sys
import unittest

PATH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "measure", "measure_modes")
sys.path.insert(0, os.path.dirname(PATH))
loader = importlib.machinery.SourceFileLoader("measure_modes", PATH)
measure_modes = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure_modes", loader))
loader.exec_module(measure_modes)


def table(found, frequency_error=0.0, damping_error=0.0, below_dB=100.0):
    row = {"mode": "bending 1", "frequency_error": frequency_error, "damping_error": damping_error}
    return [{"body": "a bar", "driven": 3, "modes": [row] * found, "nodal_lines": [{"mode": "bending 1", "below_dB": below_dB}]}]


class Check(unittest.TestCase):
    def test_passes_when_every_excited_mode_was_found(self):
        self.assertEqual(list(measure_modes.failures(table(3))), [])

    def test_refuses_missing_and_additional_modes(self):
        for found in (2, 4, 0):
            self.assertEqual(list(measure_modes.failures(table(found))),
                             [f"a bar: {found} modes were found, but by closed forms the hit excites 3"])

    def test_refuses_wrong_frequencies_and_dampings(self):
        for wrong in ({"frequency_error": 0.0011}, {"damping_error": -0.051}, {"below_dB": 39.9}):
            self.assertNotEqual(list(measure_modes.failures(table(3, **wrong))), [])


class Expected(unittest.TestCase):
    def test_a_strike_excites_all_modes_except_on_their_nodal_lines(self):
        # On the middle of a plate: those with m and n odd, 4 of 16.
        keys = [(m, n) for m in range(1, 5) for n in range(1, 5)]
        self.assertEqual(measure_modes.driven(keys, [measure_modes.plate_shape(key, (0.5, 0.5)) for key in keys]), 4)

    def test_each_body_is_struck_where_all_of_its_modes_are_excited(self):
        counts = []
        for _, _, expected, count, _ in measure_modes.bodies(measure_modes.materials()):
            self.assertEqual(count, len(expected))
            counts.append(count)
        # The plate has more modes than are rendered; six of the shell and of the body with measured modes are asked for.
        self.assertEqual(counts[1:], [measure_modes.MAX_MODES, measure_modes.SHELL_MODES, 6])


if __name__ == "__main__":
    unittest.main()
