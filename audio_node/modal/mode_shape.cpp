#include "audio_node/modal/mode_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "audio_node/modal/disc.h"
#include "audio_node/modal/modal.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using std::numbers::sqrt2;

// Position along a length, 0 .. 1, of a coordinate with origin in the middle.
double along(double coordinate_m, double length_m) { return std::clamp(coordinate_m / length_m + 0.5, 0.0, 1.0); }

// A function along one direction of a plate, mean square 1, and its slope per metre.
using Profile = std::function<BeamValue(double coordinate_m)>;

// Displacement of a point of the plate off its mid-plane: w upwards, -z grad w in the plane.
ModeShape plate_shape(Profile x, Profile y) {
  return [x = std::move(x), y = std::move(y)](const Vector3d& p, const Vector3d& n) {
    const BeamValue u = x(p.x()), v = y(p.y());
    return n.z() * u.value * v.value - p.z() * (n.x() * u.slope * v.value + n.y() * u.value * v.slope);
  };
}

// Function with n nodal lines of a free plate: rigid motions first, then those of a beam.
BeamValue free_profile(int n, double coordinate_m, double length_m) {
  const double x = along(coordinate_m, length_m);
  if (n == 0) return {1, 0};
  if (n == 1) return {std::sqrt(3) * (2 * x - 1), 2 * std::sqrt(3) / length_m};
  const BeamValue beam = free_beam(n - 2, x);
  return {beam.value, beam.slope / length_m};
}

// Sine of i half waves, or its rms value where all places are equally likely.
BeamValue supported_profile(int i, double coordinate_m, double length_m, bool patch) {
  if (patch) return {1, 0};
  const double k = i * pi / length_m, x = along(coordinate_m, length_m) * length_m;
  return {sqrt2 * std::sin(k * x), sqrt2 * k * std::cos(k * x)};
}

// Radial function of a mode of a free disc: J_n(kr) + c I_n(kr).
class DiscProfile {
 public:
  DiscProfile(int diameters, double lambda, double poissons_ratio)
      : functions_(diameters, poissons_ratio), lambda_(lambda), c_(functions_.modified_share(lambda)) {
    // Mean square over the disc, of the two degenerate modes together: 2 integral R^2 x dx, and half of it for
    // each where it has diameters.
    constexpr int kSteps = 400;  // Simpson's rule: error below 1e-6 for the listed modes
    double sum = 0;
    for (int s = 0; s <= kSteps; ++s) {
      const double x = static_cast<double>(s) / kSteps, weight = s == 0 || s == kSteps ? 1 : s % 2 ? 4 : 2;
      sum += weight * raw(x) * raw(x) * x;
    }
    const double mean_square = 2 * sum / (3 * kSteps) / (diameters > 0 ? 2 : 1);
    scale_ = 1 / std::sqrt(mean_square);
  }
  // x: distance from the centre, 0 .. 1 of the radius. The slope is per radius.
  double value(double x) const { return scale_ * raw(x); }
  double slope(double x) const {
    return scale_ * lambda_ * (functions_.slope(lambda_ * x, false) + c_ * functions_.slope(lambda_ * x, true));
  }

 private:
  double raw(double x) const { return functions_.value(lambda_ * x, false) + c_ * functions_.value(lambda_ * x, true); }

  DiscFunctions functions_;
  double lambda_, c_, scale_ = 1;
};

}  // namespace

BeamValue free_beam(int n, double x) {
  const double b = free_bar_root(n), s = std::sin(b), e = std::exp(-b);
  // cosh bx + cos bx - q (sinh bx + sin bx), q = (cosh b - cos b) / (sinh b - sin b), with the growing part
  // written so that large numbers do not cancel.
  const double c = std::cos(b), below = 1 - e * e - 2 * s * e;
  const double q = (1 + e * e - 2 * c * e) / below;
  const double grows = (c - s - e) / below * std::exp(-b * (1 - x)), falls = (1 + q) / 2 * std::exp(-b * x);
  return {grows + falls + std::cos(b * x) - q * std::sin(b * x),
          b * (grows - falls - std::sin(b * x) - q * std::cos(b * x))};
}

ModeShape bar_bending_shape(int n, double length_m, int across) {
  return [=](const Vector3d& p, const Vector3d& direction) {
    const BeamValue w = free_beam(n, along(p.x(), length_m));
    return direction[across] * w.value - direction.x() * p[across] * w.slope / length_m;
  };
}

ModeShape round_bending_shape(int n, double length_m) {
  return [=](const Vector3d& p, const Vector3d& direction) {
    const BeamValue w = free_beam(n, along(p.z(), length_m));
    const Eigen::Vector2d drive = w.value * direction.head<2>() - direction.z() * w.slope / length_m * p.head<2>();
    return std::copysign(drive.norm(), w.value);
  };
}

ModeShape stretching_shape(int n, double length_m, int axis) {
  return [=](const Vector3d& p, const Vector3d& direction) {
    return direction[axis] * sqrt2 * std::cos(n * pi * along(p[axis], length_m));
  };
}

ModeShape torsion_shape(int n, double length_m, int axis, double gyration_m) {
  return [=](const Vector3d& p, const Vector3d& direction) {
    return p.cross(direction)[axis] / gyration_m * sqrt2 * std::cos(n * pi * along(p[axis], length_m));
  };
}

ModeShape supported_plate_shape(int i, int k, double a_m, double b_m, const Patch& patch) {
  return plate_shape([=](double x) { return supported_profile(i, x, a_m, patch.x); },
                     [=](double y) { return supported_profile(k, y, b_m, patch.y); });
}

ModeShape free_plate_shape(int i, int k, double a_m, double b_m) {
  return plate_shape([=](double x) { return free_profile(i, x, a_m); },
                     [=](double y) { return free_profile(k, y, b_m); });
}

ModeShape free_disc_shape(int diameters, int circles, double radius_m, double poissons_ratio) {
  const double lambda = free_disc_lambda(diameters, circles, poissons_ratio);
  return [profile = DiscProfile(diameters, lambda, poissons_ratio), radius_m](const Vector3d& p, const Vector3d& n) {
    const double r = p.head<2>().norm(), x = std::min(r / radius_m, 1.0);
    const double outward = r > 1e-9 ? p.head<2>().dot(n.head<2>()) / r : 0;
    return n.z() * profile.value(x) - p.z() * outward * profile.slope(x) / radius_m;
  };
}

}  // namespace tactus::audio
