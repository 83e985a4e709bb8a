// Where a tool with a shape may meet the surfaces near it: pairs of points with their gaps, from the detector that
// the bodies' own contacts come from. Pure.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/collision/closest_surface.h"
#include "sim_node/collision/detector.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// A place of a surface, and the point of the tool that faces it.
struct ToolMeeting {
  SurfacePlane plane;                     // world; its distance is the gap
  Eigen::Vector3d tool_point_m{0, 0, 0};  // in the tool's frame
};

// A tool touches from a skin on, by which its edges are rounded: so it never overlaps with what it is pressed on,
// where pairs of points have no direction to be trusted.
class ShapeSearch {
 public:
  // Places of one direction whose points on the tool are nearer than this are one. Design: a quarter of the margin
  // of a touch model, far below a hand's breadth, so that 49 planes reach around a tool.
  static constexpr double kSamePlace_m = 0.002;

  // Design: less than a hand finds by pressing, a hundred times what a proxy may be off.
  static constexpr double kSkin_m = 0.0001;

  // trees: of this world; outlives this.
  ShapeSearch(const WorldDef& world, int tool, const Settings& settings, MeshTrees& trees);
  // Makes a shape of the world ready; they are numbered from 0 on.
  void add(const ShapeDef& shape, const WorldDef& world);

  // The meetings with that shape, nearest first, into `out`, cleared first. Deterministic. Realtime-safe once its
  // lists have grown.
  void query(std::size_t shape, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& tool_pose, double reach_m,
             std::vector<ToolMeeting>& out);

 private:
  double same_direction_;  // cosine
  std::unique_ptr<Detector> detector_;
  int tool_;
  std::vector<int> numbers_;
  std::vector<PointPair> pairs_;
};

}  // namespace tactus::sim
