"""Tests that the information of percepts agrees with closed forms, and that its intervals hold the truth."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))

from tactus.information import estimate, noise  # noqa: E402
from tactus.information.estimate import Observer, Percept  # noqa: E402

DRAWS = 20_000
SE = 4.0  # of a mean: a correct estimate fails once in 16,000


def percept(sense, means, sd=1.0, wrong=0.0):
    """A percept of one component; means [value] or [value, variant]."""
    means = np.asarray(means, dtype=float)
    means = means.reshape(len(means), -1, 1)
    return Percept(sense, means, np.full(means.shape, sd), wrong)


def normal_cdf(x):
    return 0.5 * (1 + math.erf(x / math.sqrt(2)))


def bits_of_d_prime(d):
    """Information of two equally likely values whose percepts are d standard deviations apart: 1 - E log2(1 + exp(-d z - d^2/2)), by the trapezium rule."""
    z = np.linspace(-12, 12, 200_001)
    density = np.exp(-z * z / 2) / math.sqrt(2 * math.pi)
    return 1 - float(np.sum(density * np.logaddexp(0, -d * z - d * d / 2)) * (z[1] - z[0]) / math.log(2))


class Information(unittest.TestCase):
    def near(self, result, bits, message=None, rounded=1e-9):
        """The interval of 95 %, widened to SE standard errors, holds the closed form. rounded: error of the closed form itself."""
        half = (result["bits_interval"][1] - result["bits"]) / estimate.Z95 * SE + rounded
        self.assertAlmostEqual(result["bits"], bits, delta=half, msg=message)

    def test_two_values_carry_the_bits_of_their_d_prime(self):
        for d in (0.2, 0.5, 1.0, 2.0, 4.0):
            result = Observer([percept("audio", [0, d])], DRAWS).result(["audio"])
            self.near(result, bits_of_d_prime(d), d)
            right = normal_cdf(d / 2)
            self.assertAlmostEqual(result["success"], right, delta=SE * math.sqrt(right * (1 - right) / DRAWS))

    def test_a_gaussian_channel_carries_half_the_logarithm_of_one_plus_the_signal_to_noise_ratio(self):
        values = np.linspace(-5, 5, 201)  # steps of 0.05, below a tenth of the noise: as good as continuous
        prior = np.exp(-values**2 / 2)
        prior /= prior.sum()
        for sd in (0.5, 1.0, 3.0):
            result = Observer([percept("haptic", values, sd)], 4000, prior=prior).result(["haptic"])
            self.near(result, 0.5 * math.log2(1 + 1 / sd**2), sd, rounded=1e-4)  # values end at 5 deviations

    def test_a_channel_with_known_confusions_carries_their_transmitted_information(self):
        for right, bits in ((0.9, 1.01597), (0.67, 0.34004)):  # three values, even errors
            observer = Observer([percept("audio", [0, 100, 200], 1.0, noise.confusion(right, 3))], DRAWS)
            result = observer.result(["audio"])
            self.near(result, bits, right, rounded=5e-6)  # published with five decimals
            self.assertAlmostEqual(result["success"], right, delta=SE * math.sqrt(right * (1 - right) / DRAWS))
            self.assertAlmostEqual(result["answered_bits"], bits, delta=0.03)

    def test_the_information_of_answers_agrees_with_the_table_and_its_bias(self):
        self.assertAlmostEqual(estimate.transmitted_bits(np.full((3, 3), 1e9)), 0, places=6)
        self.assertAlmostEqual(estimate.transmitted_bits(np.diag([1e9] * 4)), 2, places=6)
        table = np.array([[27, 2, 1], [1, 27, 2], [2, 1, 27]])
        p = table / 90
        plain = float(np.sum(p * np.log2(p / (p.sum(1, keepdims=True) * p.sum(0, keepdims=True)))))
        self.assertAlmostEqual(plain - estimate.transmitted_bits(table), 0.03206, places=5)

    def test_independent_senses_add_the_squares_of_their_d_primes(self):
        observer = Observer([percept("visual", [0, 1.2]), percept("haptic", [0, 0.9])], DRAWS)
        self.near(observer.result(["visual", "haptic"]), bits_of_d_prime(1.5))
        self.near(observer.result(["haptic"]), bits_of_d_prime(0.9))
        gain = observer.gain("haptic")
        self.near(gain, bits_of_d_prime(1.5) - bits_of_d_prime(1.2))
        self.assertGreater(gain["bits_interval"][0], 0)

    def test_a_sense_that_lapses_carries_the_attended_share_of_its_bits(self):
        for lapse in (0.1, 0.5):
            result = Observer([percept("audio", [0, 2.0])], DRAWS, lapse=lapse).result(["audio"])
            self.near(result, (1 - lapse) * bits_of_d_prime(2.0), lapse)

    def test_a_percept_of_the_variant_alone_carries_nothing_and_helps_to_read_another(self):
        variants = np.array([0.0, 10.0, 20.0])
        loudness = variants[None, :] + np.array([0.0, 5.0])[:, None]  # 5 more for the second value, on an unknown start
        observer = Observer([percept("audio", loudness, 8.0), percept("visual", np.tile(variants, (2, 1)), 0.1)], DRAWS)
        self.assertLess(abs(observer.result(["visual"])["bits"]), 1e-9)
        self.near(observer.result(["audio", "visual"]), bits_of_d_prime(5 / 8))
        self.assertLess(observer.result(["audio"])["bits"], bits_of_d_prime(5 / 8) - 0.02)

    def test_a_sense_without_differences_is_at_chance_and_has_no_gain(self):
        observer = Observer([percept("audio", [0, 1, 2, 3, 4], 0.1), percept("thermal", [7] * 5, 0.1)], 1000)
        alone = observer.result(["thermal"])
        self.assertLess(abs(alone["bits"]), 1e-9)
        self.assertAlmostEqual(alone["success"], 0.2, places=12)
        self.assertLess(abs(observer.gain("thermal")["bits_interval"][1]), 1e-9)
        self.assertAlmostEqual(observer.result([])["success"], 0.2, places=12)

    def test_intervals_hold_the_truth_in_95_of_100(self):
        truth, held, repetitions = bits_of_d_prime(1.0), 0, 600
        for seed in range(repetitions):
            low, high = Observer([percept("audio", [0, 1.0])], 200, seed).result(["audio"])["bits_interval"]
            held += low <= truth <= high
        self.assertGreaterEqual(held / repetitions, 0.93)
        self.assertLessEqual(held / repetitions, 0.97)


class Shares(unittest.TestCase):
    def test_shapley_shares_agree_with_a_computed_example_and_add_up(self):
        worth = {"": 0.10, "V": 0.60, "T": 0.50, "A": 0.20, "TV": 0.90, "AV": 0.65, "AT": 0.60, "ATV": 0.96}
        shares = estimate.shapley(["A", "T", "V"], lambda senses: worth["".join(sorted(senses))])
        for name, share in (("A", 0.07833), ("T", 0.35333), ("V", 0.42833)):
            self.assertAlmostEqual(shares[name], share, places=5)
        self.assertAlmostEqual(sum(shares.values()), 0.86, places=12)


if __name__ == "__main__":
    unittest.main()
