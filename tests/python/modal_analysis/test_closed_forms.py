"""The closed forms for measure_modes agree with published values."""
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.modal_analysis import closed_forms as forms

STEEL = {"youngs_modulus_Pa": 2.0e11, "poissons_ratio": 0.29, "density_kg_m3": 7850, "rayleigh_alpha_1_s": 5, "rayleigh_beta_s": 3e-8}


class ClosedForms(unittest.TestCase):
    def test_roots_of_a_free_bar(self):
        # Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1, free-free.
        for root, printed in zip(forms.free_bar_roots(5), (4.73004074, 7.85320462, 10.9956078, 14.1371655, 17.2787597)):
            self.assertAlmostEqual(root, printed, delta=1e-7 * printed)

    def test_a_steel_bar_of_300_x_5_mm(self):
        self.assertAlmostEqual(forms.euler_bernoulli_Hz(STEEL, 0.3, 0.005, forms.free_bar_roots(1)[0]), 288.2, delta=0.1)
        # Shear and rotary inertia: (beta r)^2 (1 + 3.1) / 2 = 1.05e-3 of it.
        self.assertAlmostEqual(forms.free_bar_Hz(STEEL, 0.3, 0.005, 1)[0] / 288.25, 1 - 1.05e-3, delta=1e-4)

    def test_nodal_points_of_a_free_bar(self):
        # Fletcher and Rossing, The Physics of Musical Instruments, 2nd ed., figure 2.21: 0.224 and 0.132 of the length.
        roots = forms.free_bar_roots(2)
        self.assertAlmostEqual(forms.free_bar_node(roots[0]), 0.2242, delta=1e-4)
        self.assertAlmostEqual(forms.free_bar_node(roots[1]), 0.1321, delta=1e-4)

    def test_a_thin_square_supported_plate(self):
        # Leissa, table 4.1: omega a^2 sqrt(rho h / D) = pi^2 (m^2 + n^2) = 19.739, 49.348, 78.957. At 5000 times the thickness shear and
        # rotary inertia lower the highest of them by 1e-5.
        modes = forms.supported_plate_Hz(STEEL, 0.5, 0.5, 1e-4, 2000)
        rigidity = 2.0e11 * 1e-12 / (12 * (1 - 0.29 ** 2))
        for key, printed in (((1, 1), 19.739), ((1, 2), 49.348), ((2, 1), 49.348), ((2, 2), 78.957)):
            value = 2 * math.pi * modes[key] * 0.25 * math.sqrt(7850 * 1e-4 / rigidity)
            self.assertAlmostEqual(value, printed, delta=0.001)
        self.assertEqual(list(modes.values()), sorted(modes.values()))

    def test_a_thick_square_supported_plate(self):
        # Three-dimensional elasticity, h / a = 0.1, nu = 0.3: omega h sqrt(rho / G) (Srinivas, Joga Rao and Rao, J. Sound Vib. 12, 1970,
        # p. 187). Mindlin's equations are within 0.7 % of it.
        of = {**STEEL, "poissons_ratio": 0.3}
        modes = forms.supported_plate_Hz(of, 0.5, 0.5, 0.05, 20000)
        for key, printed in (((1, 1), 0.0932), ((1, 2), 0.2226), ((2, 2), 0.3421), ((1, 3), 0.4171), ((2, 3), 0.5239)):
            value = 2 * math.pi * modes[key] * 0.05 * math.sqrt(7850 / (2.0e11 / 2.6))
            self.assertAlmostEqual(value / printed, 1, delta=0.008)

    def test_a_spherical_shell(self):
        # Baker 1961, nu = 0.3: O = omega R sqrt(rho (1 - nu^2) / E) of the lower branch is 0.701 for n = 2 and 0.830 for n = 3. High
        # orders stretch a piece of the shell as if it were alone: omega R = sqrt(E / rho).
        of = {**STEEL, "poissons_ratio": 0.3}
        omegas = [2 * math.pi * f / math.sqrt(2.0e11 / 7850) for f in forms.spherical_shell_Hz(of, 1.0, (2, 3, 60))]
        self.assertAlmostEqual(omegas[0] * math.sqrt(1 - 0.09), 0.701, delta=0.001)
        self.assertAlmostEqual(omegas[1] * math.sqrt(1 - 0.09), 0.830, delta=0.001)
        self.assertAlmostEqual(omegas[2], 1.0, delta=0.001)

    def test_damping(self):
        self.assertAlmostEqual(forms.damping_1_s(STEEL, 1000), (5 + 3e-8 * (2000 * math.pi) ** 2) / 2)


if __name__ == "__main__":
    unittest.main()
