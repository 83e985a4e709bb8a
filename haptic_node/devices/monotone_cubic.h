// A curve through points at given times with continuous velocity that never overshoots a point: monotone cubic
// Hermite interpolation per coordinate, slopes after Fritsch and Butland (1984), as in PCHIP. A hand comes to rest
// at a waypoint where it reverses; at other waypoints it keeps moving.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tactus::haptic {

class MonotoneCubic {
 public:
  struct At {
    Eigen::Vector3d position;  // m
    Eigen::Vector3d velocity;  // m/s
  };
  enum class Ends { kRest, kMoving };

  // Times in s, strictly increasing, one per point, at least one point.
  MonotoneCubic(std::vector<double> times_s, std::vector<Eigen::Vector3d> points_m, Ends ends);

  // Constant before the first and after the last point. Realtime-safe: yes.
  At at(double time_s) const;
  double begin_s() const { return times_.front(); }
  double end_s() const { return times_.back(); }
  // Index of the last point at or before the time, and the fraction (0 .. 1) towards the next point.
  std::pair<std::size_t, double> locate(double time_s) const;

 private:
  std::vector<double> times_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> slopes_;
};

}  // namespace tactus::haptic
