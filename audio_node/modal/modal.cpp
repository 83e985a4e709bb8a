#include "audio_node/modal/modal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace tactus::audio {
namespace {

using std::numbers::pi;

// Upper bound of the nodal lines of a plate: 128 modes end far below.
constexpr int kMaxLines = 256;

// frequency(n), n = 0, 1, ..., ascending, within the range; numbered from `first` on.
template <class F>
std::vector<NaturalFrequency> ascending(ModeRange range, int first, F frequency) {
  std::vector<NaturalFrequency> out;
  for (int n = 0; n < range.max_modes; ++n) {
    const double f = frequency(n);
    if (!(f < range.below_Hz)) break;
    out.push_back({f, n + first});
  }
  return out;
}

std::vector<NaturalFrequency> sorted(std::vector<NaturalFrequency> all, ModeRange range) {
  std::erase_if(all, [&](const NaturalFrequency& m) { return !(m.frequency_Hz > 0 && m.frequency_Hz < range.below_Hz); });
  std::stable_sort(all.begin(), all.end(),
                   [](const NaturalFrequency& a, const NaturalFrequency& b) { return a.frequency_Hz < b.frequency_Hz; });
  if (all.size() > static_cast<std::size_t>(range.max_modes)) all.resize(static_cast<std::size_t>(range.max_modes));
  return all;
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
Beam free_beam_mode(int n) {
  if (n == 0) return {0, 0, 0};
  if (n == 1) return {0, 0, 12 / (pi * pi)};
  const double k = n == 2 ? 1.506 : n - 0.5;
  const double q = (n - 0.5) * pi;
  return n == 2 ? Beam{k, 1.248, 5.017} : Beam{k, k * k * (1 - 2 / q), k * k * (1 + 6 / q)};
}

// Modes of a plate by numbers of half waves or nodes in both directions, within the range: beyond the rigid
// motions, more lines mean a higher mode.
template <class F>
std::vector<NaturalFrequency> plate_modes(ModeRange range, int first, F frequency) {
  std::vector<NaturalFrequency> all;
  for (int m = first; m < kMaxLines; ++m) {
    for (int n = first; n < kMaxLines; ++n) {
      const double f = frequency(m, n);
      if (f >= range.below_Hz && n > 1) break;
      all.push_back({f, m, n});
    }
    if (m > 1 && frequency(m, first) >= range.below_Hz) break;
  }
  return sorted(std::move(all), range);
}

// Modes of a free disc, nu = 0.33 (Leissa, table 2.5).
struct DiscMode {
  double lambda2;
  int diameters, circles;
};
constexpr std::array<DiscMode, 10> kDisc{{{5.253, 2, 0},
                                        {9.084, 0, 1},
                                        {12.23, 3, 0},
                                        {20.52, 1, 1},
                                        {21.6, 4, 0},
                                        {33.1, 5, 0},
                                        {35.25, 2, 1},
                                        {38.55, 0, 2},
                                        {52.91, 3, 1},
                                        {59.86, 1, 2}}};

}  // namespace

double free_bar_root(int n) {
  constexpr std::array<double, 4> kRoots{4.7300407, 7.8532046, 10.9956078, 14.1371655};
  return n < 4 ? kRoots[static_cast<std::size_t>(n)] : (n + 1.5) * pi;
}

double damping_1_s(const Elastic& m, double frequency_Hz) {
  const double w = 2 * pi * frequency_Hz;
  return (m.rayleigh_alpha_1_s + m.rayleigh_beta_s * w * w) / 2;
}

double bar_speed_m_s(const Elastic& m) { return std::sqrt(m.youngs_modulus_Pa / m.density_kg_m3); }
double shear_speed_m_s(const Elastic& m) { return bar_speed_m_s(m) / std::sqrt(2 * (1 + m.poissons_ratio)); }

std::vector<NaturalFrequency> thick_bar_bending(const Elastic& m, double length_m, double gyration_m, ModeRange range) {
  return ascending(range, 0, [&](int n) {
    const double b = free_bar_root(n) / length_m, br = b * gyration_m;
    const double shear = 2 * (1 + m.poissons_ratio) * 6 / 5;  // E / (kappa G)
    return b * br * bar_speed_m_s(m) / (2 * pi) / std::sqrt(1 + br * br * (1 + shear));
  });
}

std::vector<NaturalFrequency> free_bar_harmonics(double speed_m_s, double length_m, ModeRange range) {
  return ascending(range, 1, [&](int n) { return (n + 1) * speed_m_s / (2 * length_m); });
}

std::vector<NaturalFrequency> supported_plate(const Elastic& m, double a_m, double b_m, double thickness_m, ModeRange range) {
  const double c = pi / 2 * plate_constant(m, thickness_m);
  return plate_modes(range, 1, [&](int i, int k) { return c * (i * i / (a_m * a_m) + k * k / (b_m * b_m)); });
}

std::vector<NaturalFrequency> free_plate(const Elastic& m, double a_m, double b_m, double thickness_m, ModeRange range) {
  const double ratio = a_m / b_m, nu = m.poissons_ratio;
  return plate_modes(range, 0, [&](int i, int k) {
    const Beam x = free_beam_mode(i), y = free_beam_mode(k);
    const double lambda2 = pi * pi *
                           std::sqrt(std::pow(x.g, 4) + std::pow(y.g * ratio, 4) +
                                     2 * ratio * ratio * (nu * x.h * y.h + (1 - nu) * x.j * y.j));
    return lambda2 / (2 * pi * a_m * a_m) * plate_constant(m, thickness_m);
  });
}

std::vector<NaturalFrequency> free_disc(const Elastic& m, double radius_m, double thickness_m, ModeRange range) {
  std::vector<NaturalFrequency> all;
  for (const DiscMode& l : kDisc)
    all.push_back(
        {l.lambda2 / (2 * pi * radius_m * radius_m) * plate_constant(m, thickness_m), l.diameters, l.circles});
  return sorted(std::move(all), range);
}

double free_disc_lambda2(int diameters, int circles) {
  const auto found = std::find_if(kDisc.begin(), kDisc.end(), [&](const DiscMode& l) {
    return l.diameters == diameters && l.circles == circles;
  });
  if (found == kDisc.end()) throw std::logic_error("the list has no such mode of a disc");
  return found->lambda2;
}

std::vector<NaturalFrequency> solid_ball(const Elastic& m, double radius_m, ModeRange range) {
  constexpr std::array kShearWaveNumbers{2.639, 3.424, 3.916, 4.440, 4.865, 5.010, 6.033, 6.455, 6.772, 7.023};
  std::vector<NaturalFrequency> all;
  for (const double k : kShearWaveNumbers) all.push_back({k * shear_speed_m_s(m) / (2 * pi * radius_m)});
  return sorted(std::move(all), range);
}

std::vector<NaturalFrequency> spherical_shell(const Elastic& m, double radius_m, ModeRange range) {
  const double nu = m.poissons_ratio;
  const double c = std::sqrt(m.youngs_modulus_Pa / (m.density_kg_m3 * (1 - nu * nu))) / (2 * pi * radius_m);
  return ascending(range, 2, [&](int i) {
    const double l = (i + 2) * (i + 3);
    const double p = 1 + 3 * nu + l, q = (1 - nu * nu) * (l - 2);
    return c * std::sqrt((p - std::sqrt(p * p - 4 * q)) / 2);
  });
}

}  // namespace tactus::audio
