// A curve through points at given times with continuous velocity that never overshoots a point: monotone cubic
// Hermite interpolation per coordinate, slopes after Fritsch and Butland (1984), as in PCHIP. A hand that turns
// round at a waypoint comes to rest there; one that goes on does not.
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

  // Before the first and after the last point it rests there. Realtime-safe: yes.
  At at(double time_s) const;
  double begin_s() const { return times_.front(); }
  double end_s() const { return times_.back(); }
  // Index of the last point at or before the time, and how far (0 .. 1) the next one is reached.
  std::pair<std::size_t, double> locate(double time_s) const;

 private:
  std::vector<double> times_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> slopes_;
};

}  // namespace tactus::haptic
