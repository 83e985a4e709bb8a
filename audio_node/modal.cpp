#include "audio_node/modal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

using std::numbers::pi;

// Appends frequency(n), n = 0, 1, ..., which ascends, as far as the range goes.
template <class F>
std::vector<double> ascending(Range range, F frequency) {
  std::vector<double> out;
  for (int n = 0; n < range.at_most; ++n) {
    const double f = frequency(n);
    if (!(f < range.below_Hz)) break;
    out.push_back(f);
  }
  return out;
}

std::vector<double> sorted(std::vector<double> all, Range range) {
  std::erase_if(all, [&](double f) { return !(f > 0 && f < range.below_Hz); });
  std::sort(all.begin(), all.end());
  if (all.size() > static_cast<std::size_t>(range.at_most)) all.resize(static_cast<std::size_t>(range.at_most));
  return all;
}

// beta L of a free-free bar: the roots of cos x cosh x = 1, which tend to (n + 3/2) pi.
double free_bar_root(int n) {
  constexpr std::array<double, 4> kRoots{4.7300407, 7.8532046, 10.9956078, 14.1371655};
  return n < 4 ? kRoots[static_cast<std::size_t>(n)] : (n + 1.5) * pi;
}

// sqrt(D / (rho h)), m^2/s.
double plate_constant(const Elastic& m, double thickness_m) {
  return thickness_m *
         std::sqrt(m.youngs_modulus_Pa / (12 * m.density_kg_m3 * (1 - m.poissons_ratio * m.poissons_ratio)));
}

// Warburton's G, H, J of a free-free beam function with n nodes (0: translation, 1: rotation).
struct Beam {
  double g, h, j;
};
Beam free_beam(int n) {
  if (n == 0) return {0, 0, 0};
  if (n == 1) return {0, 0, 12 / (pi * pi)};
  const double k = n == 2 ? 1.506 : n - 0.5;
  const double q = (n - 0.5) * pi;
  return n == 2 ? Beam{k, 1.248, 5.017} : Beam{k, k * k * (1 - 2 / q), k * k * (1 + 6 / q)};
}

// Modes of a plate by numbers of half waves or nodes in both directions; enough of them that none below the
// range's end is missed, unless there are far more than can be used.
template <class F>
std::vector<double> plate_modes(Range range, int first, F frequency) {
  const int most = 2 * range.at_most;
  std::vector<double> all;
  for (int m = first; m < most; ++m)
    for (int n = first; n < most; ++n) all.push_back(frequency(m, n));
  return sorted(std::move(all), range);
}

}  // namespace

double damping_1_s(const Elastic& m, double frequency_Hz) {
  const double w = 2 * pi * frequency_Hz;
  return (m.rayleigh_alpha_1_s + m.rayleigh_beta_s * w * w) / 2;
}

double bar_speed_m_s(const Elastic& m) { return std::sqrt(m.youngs_modulus_Pa / m.density_kg_m3); }
double shear_speed_m_s(const Elastic& m) { return bar_speed_m_s(m) / std::sqrt(2 * (1 + m.poissons_ratio)); }

std::vector<double> free_bar_bending(const Elastic& m, double length_m, double gyration_m, Range range) {
  return ascending(range, [&](int n) {
    const double b = free_bar_root(n) / length_m;
    return b * b * gyration_m * bar_speed_m_s(m) / (2 * pi);
  });
}

std::vector<double> thick_bar_bending(const Elastic& m, double length_m, double gyration_m, Range range) {
  return ascending(range, [&](int n) {
    const double b = free_bar_root(n) / length_m, br = b * gyration_m;
    const double shear = 2 * (1 + m.poissons_ratio) * 6 / 5;  // E / (kappa G)
    return b * br * bar_speed_m_s(m) / (2 * pi) / std::sqrt(1 + br * br * (1 + shear));
  });
}

std::vector<double> free_bar_harmonics(double speed_m_s, double length_m, Range range) {
  return ascending(range, [&](int n) { return (n + 1) * speed_m_s / (2 * length_m); });
}

std::vector<double> supported_plate(const Elastic& m, double a_m, double b_m, double thickness_m, Range range) {
  const double c = pi / 2 * plate_constant(m, thickness_m);
  return plate_modes(range, 1, [&](int i, int k) { return c * (i * i / (a_m * a_m) + k * k / (b_m * b_m)); });
}

std::vector<double> free_plate(const Elastic& m, double a_m, double b_m, double thickness_m, Range range) {
  const double ratio = a_m / b_m, nu = m.poissons_ratio;
  return plate_modes(range, 0, [&](int i, int k) {
    const Beam x = free_beam(i), y = free_beam(k);
    const double lambda2 = pi * pi *
                           std::sqrt(std::pow(x.g, 4) + std::pow(y.g * ratio, 4) +
                                     2 * ratio * ratio * (nu * x.h * y.h + (1 - nu) * x.j * y.j));
    return lambda2 / (2 * pi * a_m * a_m) * plate_constant(m, thickness_m);
  });
}

std::vector<double> free_disc(const Elastic& m, double radius_m, double thickness_m, Range range) {
  constexpr std::array kLambda2{5.253, 9.084, 12.23, 20.52, 21.6, 33.1, 35.25, 38.55, 52.91, 59.86};
  std::vector<double> all;
  for (const double l : kLambda2)
    all.push_back(l / (2 * pi * radius_m * radius_m) * plate_constant(m, thickness_m));
  return sorted(std::move(all), range);
}

std::vector<double> solid_ball(const Elastic& m, double radius_m, Range range) {
  constexpr std::array kShearWaveNumbers{2.639, 3.424, 3.916, 4.440, 4.865, 5.010, 6.033, 6.455, 6.772, 7.023};
  std::vector<double> all;
  for (const double k : kShearWaveNumbers) all.push_back(k * shear_speed_m_s(m) / (2 * pi * radius_m));
  return sorted(std::move(all), range);
}

std::vector<double> spherical_shell(const Elastic& m, double radius_m, Range range) {
  const double nu = m.poissons_ratio;
  const double c = std::sqrt(m.youngs_modulus_Pa / (m.density_kg_m3 * (1 - nu * nu))) / (2 * pi * radius_m);
  return ascending(range, [&](int i) {
    const double l = (i + 2) * (i + 3);
    const double p = 1 + 3 * nu + l, q = (1 - nu * nu) * (l - 2);
    return c * std::sqrt((p - std::sqrt(p * p - 4 * q)) / 2);
  });
}

}  // namespace tactus::audio
