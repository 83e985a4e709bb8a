// The detector that a scene has chosen, for the pairs of shapes that it takes; all others are ODE's.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/collision/detector.h"
#include "sim_node/collision/layers/patches.h"
#include "sim_node/model/manifold.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

class ChosenDetector {
 public:
  // Throws std::runtime_error with one sentence when the chosen detector cannot take a shape of the world.
  ChosenDetector(const WorldDef& world, const Settings& settings);
  // From which gap on shapes touch, m; 0: when they overlap.
  double shell_m() const { return shell_m_; }
  // Whether it is asked about this pair. "layers" is about triangles: two boxes stay with
  // ODE. So do heightfields, which ODE holds in a frame of their own.
  bool takes(int shape_a, int shape_b) const;
  // The contact of two shapes at these poses, into `out`, cleared first. A detector that sees gaps has contacts
  // from the contact tolerance on: bodies meet at that distance, and depth is counted from there, so that they
  // only ever touch. False: the surfaces pass through each other, which it cannot resolve; ask ODE.
  bool query(int shape_a, const Eigen::Isometry3d& pose_a, int shape_b, const Eigen::Isometry3d& pose_b,
             std::vector<ManifoldPoint>& out);

 private:
  std::unique_ptr<Detector> detector_;  // null: ODE takes all
  double shell_m_ = 0;
  bool triangles_only_ = false;
  std::vector<ShapeKind> kinds_;
  std::vector<int> number_;  // per shape, of the detector; -1: none
  Patches patches_;
  std::vector<PointPair> pairs_;
  std::vector<ContactPatch> patch_list_;
};

}  // namespace tactus::sim
