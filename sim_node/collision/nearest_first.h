// Contacts one at a time, nearest first: for who needs the nearest of each place and direction only, as a tool
// does, which is far less than all of them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/model/point_pair.h"

namespace tactus::sim {

class Detector;

// Who takes them.
struct NearestFirst {
  virtual ~NearestFirst() = default;
  // Whether the pair tells nothing new; asked before what costs most is found out.
  virtual bool known(const PointPair& pair) const = 0;
  // A pair that is not known; false: no more are wanted.
  virtual bool take(const PointPair& pair) = 0;
};

// A detector that has a quicker way to these than to find all.
struct FindsNearestFirst {
  virtual ~FindsNearestFirst() = default;
  // Makes two shapes ready for that; else there is none.
  virtual void prepare_nearest_first(int a, int b) = 0;
  // False: it has none for this pair of shapes, and has told nothing.
  virtual bool nearest_first(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b,
                             double reach_m, NearestFirst& to, std::vector<PointPair>& room) = 0;
};

// Before the first search for two shapes, so that it may be quick: makes ready what the detector needs for that.
void prepare_nearest_first(Detector& detector, int a, int b);
// The pairs of detector.query() to `to`, nearest first, as long as it wants more; by the quicker way when the
// detector has one, which gives the same to within rounding. `room` is used. Realtime-safe as far as the detector
// is, where it has a quicker way.
void nearest_first(Detector& detector, int a, const Eigen::Isometry3d& pose_a, int b,
                   const Eigen::Isometry3d& pose_b, double reach_m, NearestFirst& to,
                   std::vector<PointPair>& room);
// Without a quicker way.
void nearest_first_of_all(Detector& detector, int a, const Eigen::Isometry3d& pose_a, int b,
                          const Eigen::Isometry3d& pose_b, double reach_m, NearestFirst& to,
                          std::vector<PointPair>& room);

}  // namespace tactus::sim
