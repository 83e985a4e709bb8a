#include "haptic_node/devices/spidar/spidar.h"

#include <algorithm>

#include "haptic_node/contact/rotation_math.h"

namespace tactus::haptic {
namespace {

// Largest change of the pose, in counts, when every string changes by half a count, within the workspace of every
// known frame (tests/bench/haptic_node/spidar_table).
constexpr double kPoseCounts = 1.6;
// For a grip with a single knot, which does not rotate.
constexpr double kMinLever_m = 0.001;

}  // namespace

Spidar::Spidar(StringFrame frame, const Eigen::Vector3d& origin_m, std::unique_ptr<StringMotors> motors)
    : frame_(std::move(frame)),
      origin_m_(origin_m),
      motors_(std::move(motors)),
      middle_m_(string_lengths(frame_, {})),
      velocity_(kPoseCounts * frame_.encoder_step_m),
      spin_(kPoseCounts * frame_.encoder_step_m / std::max(frame_.lever_m(), kMinLever_m)) {
  check_frame(frame_);
  tensions_.tensions_N.setConstant(frame_.size(), frame_.min_tension_N);
}

DeviceState Spidar::read(sync::HostTime now) {
  const Counts counts = motors_->read(now);
  const PerString lengths_m = middle_m_ + frame_.encoder_step_m * counts.cast<double>();
  solved_ = solve_pose(frame_, lengths_m, pose_);
  const bool lost = !solved_.converged || !(solved_.residual_m <= kLostResidual_m);
  if (lost || lost_) {
    velocity_.clear();
    spin_.clear();
  }
  lost_ = lost;
  if (!lost) {
    turned_rad_ += rotation_between(pose_.orientation, solved_.pose.orientation);
    pose_ = solved_.pose;
  }

  DeviceState state;
  state.position = origin_m_ + pose_.position_m;
  state.orientation = pose_.orientation;
  state.lost = lost;
  if (!lost) {
    state.velocity = velocity_.add(pose_.position_m, now);
    state.spin = spin_.add(turned_rad_, now);
  }
  return state;
}

double Spidar::workspace_factor() const {
  const double r = frame_.workspace_radius_m;
  return std::clamp(1 - (pose_.position_m.norm() - r) / (kEdgeShare * r), 0.0, 1.0);
}

void Spidar::write(const Wrench& wanted) {
  const double factor = lost_ ? 0 : workspace_factor();
  tensions_ = solve_tensions(frame_, pose_, {factor * wanted.force_N, factor * wanted.torque_N_m});
  const PerString min_N = PerString::Constant(frame_.size(), frame_.min_tension_N);
  motors_->write(min_N + factor * (tensions_.tensions_N - min_N));
}

}  // namespace tactus::haptic
