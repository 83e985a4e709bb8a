// Ratio of drawn to real motion of the hand. Below 1 a touched object seems to resist more, above 1 it seems to
// give way, though no force changes (pseudo-haptics: Lecuyer, Burkhardt and Etienne 2004, "Feeling bumps and holes
// without a haptic interface", who vary the control/display ratio, the inverse of this gain). Pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::visual {

class DisplayGain {
 public:
  // Design: while the gain is 1 the offset of the drawn hand decays with this time constant, slowly enough not to
  // be seen as a movement of its own; the offset never exceeds the length of a forearm.
  static constexpr double kReturn_s = 0.3;
  static constexpr double kMaxOffset_m = 0.3;

  // Call once a frame with the position of the hand, m. Returns the offset at which it is drawn, m.
  Eigen::Vector3d step(const Eigen::Vector3d& position_m, double gain, double dt_s) {
    if (before_m_) offset_m_ += (gain - 1) * (position_m - *before_m_);
    before_m_ = position_m;
    if (gain == 1) offset_m_ *= std::exp(-std::max(0.0, dt_s) / kReturn_s);
    if (const double length_m = offset_m_.norm(); length_m > kMaxOffset_m) offset_m_ *= kMaxOffset_m / length_m;
    return offset_m_;
  }
  // The hand is lost: it returns without offset.
  void reset() { *this = {}; }

 private:
  std::optional<Eigen::Vector3d> before_m_;
  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::visual
