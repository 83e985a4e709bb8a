// Nearest point pairs between a shaped tool and the surfaces near it, with their gaps, from the detector that also
// finds the contacts between bodies. Pure.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/collision/closest_surface.h"
#include "sim_node/collision/detector.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// A point of a surface, and the point of the tool that faces it.
struct ToolPointPair {
  SurfacePlane plane;                     // world frame; its distance is the gap
  Eigen::Vector3d tool_point_m{0, 0, 0};  // in the tool's frame
};

// The tool has a skin that rounds its edges. It touches at the skin, so that it never overlaps with a surface that it
// is pressed on; overlapping point pairs have no reliable direction.
class ShapeSearch {
 public:
  // Places of one direction whose points on the tool are nearer than this are merged. Design: a quarter of the margin
  // of a touch model, far below the breadth of a hand, so that 49 planes reach around a tool.
  static constexpr double kSamePosition_m = 0.002;

  // Design: less than the penetration that a hand perceives by pressing, a hundred times the error of a proxy.
  static constexpr double kSkin_m = 0.0001;

  // trees: of this world; outlives this object.
  ShapeSearch(const WorldDef& world, int tool, const Settings& settings, MeshTrees& trees);
  // Prepares a shape of the world; shapes are numbered from 0 on.
  void add(const ShapeDef& shape, const WorldDef& world);

  // The meetings with that shape, nearest first; clears `out` first. Deterministic. Realtime-safe once the lists have
  // grown.
  void query(std::size_t shape, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& tool_pose, double reach_m,
             std::vector<ToolPointPair>& out);

 private:
  double same_direction_;  // cosine of the merge angle
  std::unique_ptr<Detector> detector_;
  int tool_;
  std::vector<int> detector_ids_;
  std::vector<PointPair> pairs_;
};

}  // namespace tactus::sim
