#include "audio_node/modal/disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "audio_node/modal/modal.h"
#include "audio_node/modal/mode_range.h"

namespace tactus::audio {
namespace {

// The modes of a free disc up to lambda = 8.5, each with an interval that contains its lambda, and no other root of its number of
// diameters, for every Poisson's ratio from 0 to 0.5.
struct DiscMode {
  int diameters, circles;
  double low, high;
};
constexpr std::array<DiscMode, 12> kDiscModes{{{2, 0, 2.1, 2.55},
                                               {0, 1, 2.8, 3.1},
                                               {3, 0, 3.2, 3.8},
                                               {1, 1, 4.4, 4.6},
                                               {4, 0, 4.3, 5.0},
                                               {5, 0, 5.4, 6.1},
                                               {2, 1, 5.9, 6.0},
                                               {0, 2, 6.1, 6.3},
                                               {6, 0, 6.4, 7.2},
                                               {3, 1, 7.2, 7.4},
                                               {7, 0, 7.5, 8.3},
                                               {1, 2, 7.6, 7.8}}};

double bessel(int n, double y, bool modified) {
  const double order = std::abs(n);
  return modified ? std::cyl_bessel_i(order, y) : (n < 0 && n % 2 ? -1 : 1) * std::cyl_bessel_j(order, y);
}

double lambda_of(const DiscMode& mode, double poissons_ratio) {
  const DiscFunctions f(mode.diameters, poissons_ratio);
  const auto negative = [&](double y) {
    return f.moment(y, false) * f.shear(y, true) - f.moment(y, true) * f.shear(y, false) < 0;
  };
  double low = mode.low, high = mode.high;
  const bool sign = negative(low);
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (negative(middle) == sign ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

double DiscFunctions::value(double y, bool modified) const { return bessel(n_, y, modified); }

double DiscFunctions::slope(double y, bool modified) const {
  return (bessel(n_ - 1, y, modified) + (modified ? 1 : -1) * bessel(n_ + 1, y, modified)) / 2;
}

// w'' + nu (w'/y - n^2 w/y^2), by Bessel's equation: w'' = -w'/y + (n^2/y^2 -+ 1) w. Times y^2.
double DiscFunctions::moment(double y, bool modified) const {
  const double w = value(y, modified), d = slope(y, modified), n2 = n_ * n_;
  const double dd = -d / y + (n2 / (y * y) + (modified ? 1 : -1)) * w;
  return y * y * dd + nu_ * (y * d - n2 * w);
}

// Derivative of the Laplacian, which is -+w, and the twisting moment along the edge. Times y^3.
double DiscFunctions::shear(double y, bool modified) const {
  const double w = value(y, modified), d = slope(y, modified), n2 = n_ * n_;
  return (modified ? 1 : -1) * y * y * y * d - (1 - nu_) * n2 * (y * d - w);
}

double free_disc_lambda(int diameters, int circles, double poissons_ratio) {
  const auto found = std::find_if(kDiscModes.begin(), kDiscModes.end(), [&](const DiscMode& m) {
    return m.diameters == diameters && m.circles == circles;
  });
  if (found == kDiscModes.end()) throw std::logic_error("the list has no such mode of a disc");
  return lambda_of(*found, poissons_ratio);
}

std::vector<NaturalFrequency> free_disc(const Elastic& m, double radius_m, double thickness_m, ModeRange range) {
  std::vector<NaturalFrequency> all;
  for (const DiscMode& mode : kDiscModes) {
    const double k_1_m = lambda_of(mode, m.poissons_ratio) / radius_m;
    all.push_back({thick_plate_Hz(m, thickness_m, k_1_m), mode.diameters, mode.circles});
  }
  return in_range(std::move(all), range);
}

}  // namespace tactus::audio
