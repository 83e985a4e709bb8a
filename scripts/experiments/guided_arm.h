// The arm of a person who follows a prescribed movement along one axis, and the force of a virtual environment
// that reaches the hand late. The impedance of the arm ties the hand to the movement, as in
// observer/impedance_arm.h. Pure.
#pragma once

#include <cstddef>
#include <deque>

#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::experiments {

class GuidedArm {
 public:
  explicit GuidedArm(const observer::PlayerParameters& player) : player_(player) {}

  // One step of dt_s, at most 2 ms: the movement that the person intends, and the force on the hand, N.
  void step(double intended_m, double intended_m_s, double force_N, double dt_s);
  double place_m() const { return place_m_; }
  double speed_m_s() const { return speed_m_s_; }
  double acceleration_m_s2() const { return acceleration_m_s2_; }

 private:
  observer::PlayerParameters player_;
  double offset_m_ = 0, offset_m_s_ = 0, load_N_ = 0;
  double place_m_ = 0, speed_m_s_ = 0, acceleration_m_s2_ = 0;
};

// A value that arrives a whole number of steps late; 0 before.
class LateValue {
 public:
  explicit LateValue(std::size_t steps) : waiting_(steps, 0.0) {}
  double pass(double value) {
    waiting_.push_back(value);
    const double now = waiting_.front();
    waiting_.pop_front();
    return now;
  }

 private:
  std::deque<double> waiting_;
};

}  // namespace tactus::experiments
