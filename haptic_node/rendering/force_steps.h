// Forces in steps, as the operator force_step asks for. Pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace tactus::haptic {

// Quantises the magnitude of the force to multiples of `step_N`; 0: returns it unchanged.
inline Eigen::Vector3d quantised(const Eigen::Vector3d& force_N, double step_N) {
  const double size = force_N.norm();
  if (!(step_N > 0) || !(size > 0)) return force_N;
  return force_N * (std::round(size / step_N) * step_N / size);
}

// Energy of a spring whose force is rounded, relative to that of the spring: the area under the staircase. A force of n
// steps is rounded to N: (n N - N^2 / 2) / (n^2 / 2).
inline double rounded_energy(double force_N, double rounded_N) {
  const double error = force_N > 0 ? (force_N - rounded_N) / force_N : 0;
  return std::max(0.0, 1 - error * error);
}

}  // namespace tactus::haptic
