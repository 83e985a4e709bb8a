#include "haptic_node/devices/monotone_cubic.h"

#include <algorithm>

namespace tactus::haptic {
namespace {

// Weighted harmonic mean of the two secants; zero where they differ in sign (Fritsch and Butland 1984, eq. 4).
double inner_slope(double before, double after, double h_before, double h_after) {
  if (before * after <= 0) return 0;
  const double w1 = 2 * h_after + h_before, w2 = h_after + 2 * h_before;
  return (w1 + w2) / (w1 / before + w2 / after);
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> times_s, std::vector<Eigen::Vector3d> points_m, Ends ends)
    : times_(std::move(times_s)), points_(std::move(points_m)), slopes_(points_.size(), Eigen::Vector3d::Zero()) {
  const std::size_t n = points_.size();
  const auto step = [&](std::size_t i) { return times_[i + 1] - times_[i]; };
  const auto secant = [&](std::size_t i) -> Eigen::Vector3d { return (points_[i + 1] - points_[i]) / step(i); };
  for (std::size_t i = 1; i + 1 < n; ++i)
    for (int axis = 0; axis < 3; ++axis)
      slopes_[i][axis] = inner_slope(secant(i - 1)[axis], secant(i)[axis], step(i - 1), step(i));
  if (ends == Ends::kMoving && n > 1) {
    slopes_.front() = secant(0);
    slopes_.back() = secant(n - 2);
  }
}

std::pair<std::size_t, double> MonotoneCubic::locate(double time_s) const {
  if (time_s <= times_.front()) return {0, 0};
  if (time_s >= times_.back()) return {times_.size() - 1, 0};
  const auto next = std::upper_bound(times_.begin(), times_.end(), time_s);
  const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
  return {i, (time_s - times_[i]) / (times_[i + 1] - times_[i])};
}

MonotoneCubic::At MonotoneCubic::at(double time_s) const {
  const auto [i, s] = locate(time_s);
  if (i + 1 >= points_.size() || time_s <= times_.front()) return {points_[i], Eigen::Vector3d::Zero()};
  const double h = times_[i + 1] - times_[i];
  // Hermite basis on 0 .. 1.
  const double s2 = s * s, s3 = s2 * s;
  const Eigen::Vector3d position = (2 * s3 - 3 * s2 + 1) * points_[i] + (s3 - 2 * s2 + s) * h * slopes_[i] +
                                   (3 * s2 - 2 * s3) * points_[i + 1] + (s3 - s2) * h * slopes_[i + 1];
  const Eigen::Vector3d velocity = (6 * s2 - 6 * s) / h * (points_[i] - points_[i + 1]) +
                                   (3 * s2 - 4 * s + 1) * slopes_[i] + (3 * s2 - 2 * s) * slopes_[i + 1];
  return {position, velocity};
}

}  // namespace tactus::haptic
