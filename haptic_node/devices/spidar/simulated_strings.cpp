#include "haptic_node/devices/spidar/simulated_strings.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {

SimulatedStrings::SimulatedStrings(StringFrame frame, const Eigen::Vector3d& origin_m,
                                   std::unique_ptr<Device> hand)
    : frame_(std::move(frame)),
      origin_m_(origin_m),
      hand_(std::move(hand)),
      middle_m_(string_lengths(frame_, {})) {
  wanted_N_.setConstant(frame_.size(), frame_.min_tension_N);
  tension_N_ = wanted_N_;
}

Counts SimulatedStrings::read(sync::HostTime now) {
  state_ = hand_->read(now);
  const GripPose grip{state_.position - origin_m_, state_.orientation};
  const PerString straight_m = string_lengths(frame_, grip);
  const double dt = last_ ? sync::to_seconds(now - *last_) : 0;
  if (!last_) wound_m_ = straight_m;
  last_ = now;

  // The grip pulls a string out at any speed; a motor winds it in at most at its winding speed.
  wound_m_ = (wound_m_.array() - frame_.winding_speed_m_s * dt).max(straight_m.array()).matrix();
  const double follow = 1 - std::exp(-dt / frame_.tension_time_s);
  tension_N_ += follow * (wanted_N_ - tension_N_);

  const StructureMatrix w = structure_matrix(frame_, grip);
  felt_ = {};
  slack_ = false;
  Counts counts(frame_.size());
  for (int i = 0; i < frame_.size(); ++i) {
    const bool taut = wound_m_(i) <= straight_m(i);
    slack_ = slack_ || !taut;
    if (taut) felt_.force_N += tension_N_(i) * w.col(i).head<3>();
    if (taut && w.rows() > 3) felt_.torque_N_m += tension_N_(i) * frame_.lever_m() * w.col(i).tail<3>();
    counts(i) = static_cast<std::int32_t>(std::lround((wound_m_(i) - middle_m_(i)) / frame_.encoder_step_m));
  }
  hand_->write(felt_);
  return counts;
}

}  // namespace tactus::haptic
