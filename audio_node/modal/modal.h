// Natural frequencies of simple bodies in closed form. Pure.
#pragma once

#include <vector>

namespace tactus::audio {

// Acoustic properties of a material; fields of material_def_t.
struct Elastic {
  double youngs_modulus_Pa = 1.1e10;  // wood, NeuralSound (Jin, Li, Rensing, Zheng; SIGGRAPH 2022), material table
  double poissons_ratio = 0.25;
  double density_kg_m3 = 750;
  double rayleigh_alpha_1_s = 60;
  double rayleigh_beta_s = 2e-6;
  double restitution = 0.5;
};

// Amplitude decays as exp(-d t) with d = (alpha + beta omega^2) / 2 (Rayleigh damping).
double damping_1_s(const Elastic& material, double frequency_Hz);

// sqrt(E / rho): longitudinal waves in a thin bar. sqrt(G / rho): shear waves.
double bar_speed_m_s(const Elastic& material);
double shear_speed_m_s(const Elastic& material);

// A natural frequency and the numbers of its mode: half waves or nodes in both directions (see each list).
struct NaturalFrequency {
  double frequency_Hz;
  int i = 0, k = 0;
};

// All lists ascend and end at `below_Hz` or after `max_modes` modes.
struct ModeRange {
  double below_Hz = 16000;
  int max_modes = 32;
};

// beta L of the n-th bending mode of a free-free bar, n = 0, 1, ...: the roots of cos x cosh x = 1, which tend to
// (n + 3/2) pi.
double free_bar_root(int n);

// Bending of a free-free bar of length L with radius of gyration r (h/sqrt(12) of a rectangle, R/2 of a circle)
// (Euler-Bernoulli; Fletcher and Rossing, The Physics of Musical Instruments, 2nd ed., eq. 2.63), with the
// first-order correction for shear and rotary inertia (Graff, Wave Motion in Elastic Solids, 1975, section 3.4):
// f / sqrt(1 + (beta r)^2 (1 + E / (kappa G))), kappa = 5/6: within 10 % of Timoshenko's equations for the lowest five modes of a bar
// three times as long as thick, within 3 % from ten times on. i: from 0.
std::vector<NaturalFrequency> thick_bar_bending(const Elastic& material, double length_m, double gyration_m, ModeRange range);
// n c / (2 L), free-free (Fletcher and Rossing, section 2.14). Torsion of a round bar: with the shear speed. i: n,
// from 1.
std::vector<NaturalFrequency> free_bar_harmonics(double speed_m_s, double length_m, ModeRange range);

// Bending wave of that wavenumber in a plate, with shear and rotary inertia: the lower root of (k^2 - w^2 / c_s^2) (D k^2 - rho h^3 w^2 /
// 12) = rho h w^2, c_s^2 = kappa G / rho (Mindlin, J. Appl. Mech. 18, 1951, p. 31), kappa = 5/6 (Reissner 1945). Thin plates tend to
// k^2 sqrt(D/(rho h)), D = E h^3 / (12 (1 - nu^2)).
double thick_plate_Hz(const Elastic& material, double thickness_m, double k_1_m);

// Simply supported rectangular plate: exact with k = pi sqrt(m^2/a^2 + n^2/b^2), the wavenumber of a thin one (Leissa, Vibration of
// Plates, NASA SP-160, 1969, eq. 4.20). i, k: half waves along a and b, from 1.
std::vector<NaturalFrequency> supported_plate(const Elastic& material, double a_m, double b_m, double thickness_m,
                                     ModeRange range);
// Completely free rectangular plate: the wavenumber is that of a thin one, by the Rayleigh method with beam functions (Warburton,
// Proc. IMechE 168, 1954, table 1): within about 15 % of Leissa's table C22. Up to a thickness of a third of b the sum of both
// approximations is within 20 % of Mindlin's equations. i, k: nodal lines across a and b, from 0.
std::vector<NaturalFrequency> free_plate(const Elastic& material, double a_m, double b_m, double thickness_m, ModeRange range);
// Free circular plate: the wavenumber lambda / R is that of a thin one, by the conditions at its edge (Leissa, section 2.1.3). Up to a
// thickness of a third of the diameter within 12 % of Mindlin's equations, the lowest five within 4 %. All modes with lambda up to 7.5.
// i: nodal diameters, k: nodal circles.
std::vector<NaturalFrequency> free_disc(const Elastic& material, double radius_m, double thickness_m, ModeRange range);

// Solid ball: all spheroidal modes with k_t R up to 8, of the given Poisson's ratio (Lamb 1882; Sato and Usami, Geophys. Mag. 31,
// 1962). i: order.
std::vector<NaturalFrequency> solid_ball(const Elastic& material, double radius_m, ModeRange range);
// Thin spherical shell, membrane theory: the lower root of O^4 - (1 + 3 nu + n(n+1)) O^2 + (1 - nu^2)(n(n+1) - 2)
// = 0, O = omega R sqrt(rho (1 - nu^2) / E), n = 2, 3, ... (Baker, J. Acoust. Soc. Am. 33, 1961, p. 1749). i: n.
std::vector<NaturalFrequency> spherical_shell(const Elastic& material, double radius_m, ModeRange range);

}  // namespace tactus::audio
