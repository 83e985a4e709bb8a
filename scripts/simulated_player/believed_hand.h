// The observer player's belief about its own hand: known commands, felt places and late pictures of it, by a filter along each
// axis of the viewer (observer/delayed_kalman.h). Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scripts/simulated_player/observer/delayed_kalman.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::simulated_player {

// Place, speed, muscle force and excitation along one direction.
using HandState = Eigen::Vector4d;

class BelievedHand {
 public:
  // axes: unit vectors, columns: right, up and forward of the viewer.
  BelievedHand(const observer::PlayerParameters& player, const Eigen::Matrix3d& axes, const Eigen::Vector3d& start_m);

  // One step of kSampleStep_s with this command to the muscles.
  void predict(const Eigen::Vector3d& command_N);
  // A felt place that the player believes to be age_s old.
  void feel_place(double age_s, const Eigen::Vector3d& hand_m, double sd_m);
  // A seen place.
  void see(double age_s, const Eigen::Vector3d& hand_m, double sd_m, double depth_sd_m);
  // A place of which only the parts along the first axes of the viewer are known, right and up, each with this standard deviation.
  void see_across(double age_s, const Eigen::Vector3d& hand_m, double sd_m);
  // The felt force: the arm yields to it as its own spring does, and the player expects that.
  void feel_load(const Eigen::Vector3d& force_N);

  Eigen::Vector3d place_m();
  Eigen::Vector3d place_before_m(double age_s);
  Eigen::Vector3d speed_m_s();
  // The reference of the arm along a unit vector; its place is relative to origin_m.
  HandState state_along(const Eigen::Vector3d& direction, const Eigen::Vector3d& origin_m);
  // Variance of the place along a unit vector, m^2.
  double variance_m2(const Eigen::Vector3d& direction);

 private:
  observer::PlayerParameters player_;
  Eigen::Matrix3d axes_;
  std::vector<observer::DelayedKalman> filters_;  // one for each axis
  Eigen::Vector3d offset_m_{0, 0, 0};             // of the hand from its reference, as expected from the felt force
};

}  // namespace tactus::simulated_player
