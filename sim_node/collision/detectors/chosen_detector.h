// The detector that the scene selects, for the pairs of shapes that it supports. ODE handles all other pairs.
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
  // Throws std::runtime_error with one sentence when the selected detector does not support a shape of the world.
  ChosenDetector(const WorldDef& world, const Settings& settings);
  // Gap below which shapes are in contact, m. 0: contact starts at overlap.
  double shell_m() const { return shell_m_; }
  // Whether the selected detector handles this pair. "layers" is for triangles, so a pair of boxes stays with ODE.
  // Heightfields also stay with ODE, which holds them in a frame of their own.
  bool supports(int shape_a, int shape_b) const;
  // Writes the contact of two shapes at these poses into `out`, after clearing it. A detector that reports gaps has
  // contacts from the contact tolerance on. Depth is measured from there, so bodies meet at that distance and never
  // overlap. Returns false when the surfaces intersect, which this detector cannot resolve; query ODE then.
  bool query(int shape_a, const Eigen::Isometry3d& pose_a, int shape_b, const Eigen::Isometry3d& pose_b,
             std::vector<ManifoldPoint>& out);

 private:
  std::unique_ptr<Detector> detector_;  // null: ODE handles all pairs
  double shell_m_ = 0;
  bool triangles_only_ = false;
  std::vector<ShapeKind> kinds_;
  std::vector<int> number_;  // per shape, index in the detector; -1: none
  Patches patches_;
  std::vector<PointPair> pairs_;
  std::vector<ContactPatch> patch_list_;
};

}  // namespace tactus::sim
