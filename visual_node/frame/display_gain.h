// How far the drawn hand moves when the hand moves: less than it does, and what is touched seems to resist, more, and it
// gives way, though no force has changed (pseudo-haptics: Lecuyer, Burkhardt and Etienne 2004, "Feeling bumps and holes
// without a haptic interface", who vary the control/display ratio, the inverse of this gain). Pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::visual {

class DisplayGain {
 public:
  // Design. What has come off the hand's place returns within this time where the gain is one again: slowly enough
  // not to be seen as a movement of its own; and never comes off further than a forearm.
  static constexpr double kReturn_s = 0.3;
  static constexpr double kFarthest_m = 0.3;

  // Once a frame: where the hand is, m. Returns by how much it is drawn beside that place, m.
  Eigen::Vector3d step(const Eigen::Vector3d& position_m, double gain, double dt_s) {
    if (before_m_) off_m_ += (gain - 1) * (position_m - *before_m_);
    before_m_ = position_m;
    if (gain == 1) off_m_ *= std::exp(-std::max(0.0, dt_s) / kReturn_s);
    if (const double far = off_m_.norm(); far > kFarthest_m) off_m_ *= kFarthest_m / far;
    return off_m_;
  }
  // The hand was not seen: it begins anew where it comes back.
  void reset() { *this = {}; }

 private:
  std::optional<Eigen::Vector3d> before_m_;
  Eigen::Vector3d off_m_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::visual
