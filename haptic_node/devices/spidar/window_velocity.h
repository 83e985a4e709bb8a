// Velocity from a quantised position: the slope of the longest run of samples that one line fits within the step.
// First-order adaptive windowing, end-fit (Janabi-Sharifi, Hayward and Chen 2000): smooth at low speed, prompt at
// high speed.
#pragma once

#include <Eigen/Core>
#include <array>

#include "sync/time/time.h"

namespace tactus::haptic {

class WindowVelocity {
 public:
  // step_m: largest error of a position.
  explicit WindowVelocity(double step_m) : step_m_(step_m) {}
  // m/s, per axis over its own window; 0 until there are two samples. Realtime-safe: yes.
  Eigen::Vector3d add(const Eigen::Vector3d& position_m, sync::HostTime at);
  void clear() { count_ = 0; }

 private:
  struct Sample {
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    sync::HostTime at{};
  };
  // design: 20 ms at 1 kHz, about the lag that the servo of a hand tolerates.
  static constexpr std::size_t kMax = 20;
  const Sample& back(std::size_t age) const { return samples_[(newest_ + kMax - age) % kMax]; }

  double step_m_;
  std::array<Sample, kMax> samples_;
  std::size_t newest_ = 0, count_ = 0;
};

}  // namespace tactus::haptic
