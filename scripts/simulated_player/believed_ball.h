// The observer player's belief about one ball: its place and speed on the floor by a filter along two horizontal axes, and the
// probability that it lies in its hole. Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scripts/simulated_player/observer/delayed_kalman.h"
#include "scripts/simulated_player/observer_senses.h"

namespace tactus::simulated_player {

class BelievedBall {
 public:
  // sd_m: of the first guess.
  BelievedBall(const Goal& goal, const Viewer& viewer, const Eigen::Vector3d& guess_m, double sd_m);

  // One step of kSampleStep_s in which the ball is believed to accelerate so, m/s^2. push_m_s2: the standard deviation, along each
  // axis of the world, of an acceleration by a hand that may touch it.
  void predict(const Eigen::Vector3d& acceleration_m_s2, const Eigen::Vector3d& push_m_s2 = Eigen::Vector3d::Zero());
  // A place on the floor that is believed to be age_s old. away: horizontal unit vector from the eye; the standard deviations
  // are along it and across it. The place is weighed as one of a ball on the floor and as one of a ball in the hole, and is
  // applied while the former is more probable.
  void see(double age_s, const Eigen::Vector3d& at_m, const Eigen::Vector3d& away, double away_sd_m, double across_sd_m);
  // A picture without the ball. noticed_share: probability to notice it at its believed place on the floor.
  void miss(double age_s, double noticed_share);
  // A place from touch or hearing, as in see(), which says nothing about the hole.
  void locate(double age_s, const Eigen::Vector3d& at_m, const Eigen::Vector3d& away, double away_sd_m, double across_sd_m);
  // A fall into the hole was heard, with this probability that it was this ball.
  void hear_fall(double probability);

  Eigen::Vector3d place_m();  // its centre, on the floor
  Eigen::Vector3d place_before_m(double age_s);
  Eigen::Vector3d speed_m_s();
  double sd_m();  // of the place, the larger of both axes
  double in_hole() const { return in_hole_; }
  // Probability that its centre is over the hole, without any evidence of a fall.
  double at_hole_probability(double age_s);
  double last_seen_s = -1e9;  // when a percept of it arrived
  double at_hole_s = -1e9;    // believed time at which it reached its hole

 private:
  // Variance of such a place along axis i, m^2.
  double variance_m2(std::size_t i, const Eigen::Vector3d& away, double away_sd_m, double across_sd_m) const;

  Goal goal_;
  Eigen::Vector3d axes_[2];
  std::vector<observer::DelayedKalman> filters_;
  Eigen::Vector3d away_;
  double cotangent_ = 1;  // of the sight of the hole
  double in_hole_ = 0;
};

}  // namespace tactus::simulated_player
