// Contacts in order of increasing gap. For users that need only the nearest contact of each place and direction, such
// as a tool, which is much cheaper than all contacts.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/model/point_pair.h"

namespace tactus::sim {

class Detector;

// Receives the pairs of a search in order of increasing gap.
struct PairVisitor {
  virtual ~PairVisitor() = default;
  // Whether the pair is redundant. Called before the costly part of the narrow phase.
  virtual bool is_redundant(const PointPair& pair) const = 0;
  // Receives a pair that is not redundant. Returns false to stop the search.
  virtual bool visit(const PointPair& pair) = 0;
};

// A detector with a faster search than finding all pairs.
struct NearestFirstDetector {
  virtual ~NearestFirstDetector() = default;
  // Prepares two shapes for the fast search.
  virtual void prepare_nearest_first(int a, int b) = 0;
  // Returns false, without any callback, when there is no fast search for this pair of shapes.
  virtual bool nearest_first(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b,
                             double reach_m, PairVisitor& visitor, std::vector<PointPair>& scratch) = 0;
};

// Prepares the fast search of two shapes, if the detector has one. Call it before the first search.
void prepare_nearest_first(Detector& detector, int a, int b);
// Passes the pairs of detector.query() to `visitor`, nearest first, until it returns false. Uses the detector's
// fast search where there is one; its results are equal to within rounding. `scratch` is working memory. Real-time
// safe as far as the detector is, where it has a fast search.
void nearest_first(Detector& detector, int a, const Eigen::Isometry3d& pose_a, int b,
                   const Eigen::Isometry3d& pose_b, double reach_m, PairVisitor& visitor,
                   std::vector<PointPair>& scratch);
// The same without the fast search.
void nearest_first_of_all(Detector& detector, int a, const Eigen::Isometry3d& pose_a, int b,
                          const Eigen::Isometry3d& pose_b, double reach_m, PairVisitor& visitor,
                          std::vector<PointPair>& scratch);

}  // namespace tactus::sim
