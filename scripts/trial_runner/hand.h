// The hand that taps or presses in place of a person, so that each trial has its stimulus at the right time. Pure.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "scripts/trial_runner/requests.h"

namespace tactus::trial_runner {

class Hand {
 public:
  // Design: as the hand of sim_node/scenes/metronome.sdf.
  static constexpr double kDown_m_s = 0.49, kDwell_s = 0.04, kUp_s = 0.12;

  // Rests at `rest_m`, world; the surface to tap is `above_m` below.
  Hand(const Eigen::Vector3d& rest_m, double above_m) : rest_m_(rest_m), above_m_(above_m), position_m_(rest_m) {}

  // Starts at the next step; false: it is busy.
  bool tap(const TapRequest& request);
  bool press(const PressRequest& request);
  bool busy() const { return tap_ || press_; }
  // One step of dt_s.
  void step(double dt_s);
  const Eigen::Vector3d& position_m() const { return position_m_; }
  const Eigen::Vector3d& velocity_m_s() const { return velocity_m_s_; }
  bool presses() const { return press_.has_value(); }

 private:
  // Depth below its rest at the current time of the movement; nullopt: it has ended.
  std::optional<double> depth_below_rest_m() const;

  Eigen::Vector3d rest_m_;
  double above_m_;
  Eigen::Vector3d position_m_, velocity_m_s_ = Eigen::Vector3d::Zero();
  std::optional<TapRequest> tap_;
  std::optional<PressRequest> press_;
  double elapsed_s_ = 0;
};

}  // namespace tactus::trial_runner
