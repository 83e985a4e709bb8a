// The perceptual difference of two pictures.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace tactus::test {

// CIE 1976 L*a*b* of sRGB bytes (IEC 61966-2-1; white D65, 2 degrees).
inline Eigen::Vector3d lab_of(const std::uint8_t* rgb) {
  Eigen::Vector3d linear;
  for (int c = 0; c < 3; ++c) {
    const double e = rgb[c] / 255.0;
    linear[c] = e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
  }
  Eigen::Matrix3d xyz_of_rgb;
  xyz_of_rgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d xyz = (xyz_of_rgb * linear).cwiseQuotient(Eigen::Vector3d(0.9505, 1, 1.089));
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  return {116 * f(xyz.y()) - 16, 500 * (f(xyz.x()) - f(xyz.y())), 200 * (f(xyz.y()) - f(xyz.z()))};
}

// CIEDE2000 (CIE 142-2001) as in Sharma, Wu and Dalal (2005), "The CIEDE2000 Color-Difference Formula:
// Implementation Notes, Supplementary Test Data, and Mathematical Observations"; equation numbers in the comments.
inline double ciede2000(const Eigen::Vector3d& one, const Eigen::Vector3d& two) {
  constexpr double kTurn = 360, kRadian = std::numbers::pi / 180, k25to7 = 6103515625;
  const auto seventh = [](double c) { return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + k25to7)); };
  const double mean_chroma = (one.tail<2>().norm() + two.tail<2>().norm()) / 2;  // (3)
  const double stretch = 1.5 - 0.5 * seventh(mean_chroma);                       // 1 + G, (4)
  const auto hue = [&](const Eigen::Vector3d& lab) {                             // (7)
    if (lab.y() == 0 && lab.z() == 0) return 0.0;
    const double h = std::atan2(lab.z(), stretch * lab.y()) / kRadian;
    return h < 0 ? h + kTurn : h;
  };
  const double c1 = std::hypot(stretch * one.y(), one.z()), c2 = std::hypot(stretch * two.y(), two.z());  // (6)
  const double h1 = hue(one), h2 = hue(two);
  double dh = 0, mean_hue = h1 + h2;  // (10), (14)
  if (c1 * c2 != 0) {
    dh = h2 - h1;
    if (dh > kTurn / 2) dh -= kTurn;
    if (dh < -kTurn / 2) dh += kTurn;
    if (std::abs(h1 - h2) > kTurn / 2) mean_hue += mean_hue < kTurn ? kTurn : -kTurn;
    mean_hue /= 2;
  }
  const double dl = two.x() - one.x(), dc = c2 - c1;                       // (8), (9)
  const double dhh = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2 * kRadian);  // (11)
  const double l = (one.x() + two.x()) / 2, c = (c1 + c2) / 2;             // (12), (13)
  const auto cosine = [](double degrees) { return std::cos(degrees * kRadian); };
  const double t = 1 - 0.17 * cosine(mean_hue - 30) + 0.24 * cosine(2 * mean_hue) +
                   0.32 * cosine(3 * mean_hue + 6) - 0.20 * cosine(4 * mean_hue - 63);      // (15)
  const double sl = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));  // (18)
  const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;                                  // (19), (20)
  const double turned = 30 * std::exp(-std::pow((mean_hue - 275) / 25, 2));                 // (16)
  const double rt = -2 * seventh(c) * std::sin(2 * turned * kRadian);                       // (17), (21)
  const double x = dl / sl, y = dc / sc, z = dhh / sh;
  return std::sqrt(x * x + y * y + z * z + rt * y * z);  // (22)
}

// Differences over all pixels.
struct Difference {
  double mean = 0;
  double seen = 0;  // share of pixels with a visible difference
};

// 1: the just noticeable difference of CIEDE2000, for surfaces side by side.
inline constexpr double kJustNoticeable = 1;

// Luminance of a lightness, 1: white (CIE 15:2018, the inverse of its equation 8.3).
inline double luminance_of(double lightness) {
  const double f = (lightness + 16) / 116;
  return lightness > 8 ? f * f * f : lightness * 27 / 24389;
}

// RGBA of equal size. rounding: luminance differences up to this value do not count as visible.
inline Difference difference(std::span<const std::uint8_t> one, std::span<const std::uint8_t> two,
                             double rounding = 0) {
  Difference d;
  for (std::size_t i = 0; i + 3 < one.size(); i += 4) {
    const Eigen::Vector3d a = lab_of(&one[i]), b = lab_of(&two[i]);
    const double e = ciede2000(a, b);
    const bool rounded = rounding > 0 && std::abs(luminance_of(a[0]) - luminance_of(b[0])) <= rounding;
    d.mean += e, d.seen += e > kJustNoticeable && !rounded;
  }
  const double pixels = static_cast<double>(one.size()) / 4;
  return {d.mean / pixels, d.seen / pixels};
}

}  // namespace tactus::test
