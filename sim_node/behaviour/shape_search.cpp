#include "sim_node/behaviour/shape_search.h"

#include <algorithm>
#include <cmath>

#include "sim_node/collision/layer_options.h"
#include "sim_node/scene/tool_shape.h"

namespace tactus::sim {
namespace {

// Of one surface, the nearest: more than a touch model holds of all.
constexpr std::size_t kMostMeetings = 64;

}  // namespace

ShapeSearch::ShapeSearch(const WorldDef& world, int tool, const Settings& settings, MeshTrees& trees)
    : same_direction_(std::cos(settings.touch_merge_angle_rad)),
      detector_(make_gaps_detector(layer_options(settings),
                                   std::shared_ptr<MeshTrees>(std::shared_ptr<void>(), &trees))),
      tool_(detector_->add(tool_shape(world.tools[static_cast<std::size_t>(tool)]), world)) {}

void ShapeSearch::add(const ShapeDef& shape, const WorldDef& world) {
  numbers_.push_back(detector_->add(shape, world));
}

void ShapeSearch::query(std::size_t shape, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& tool_pose,
                        double reach_m, std::vector<ToolMeeting>& out) {
  out.clear();
  detector_->query(tool_, tool_pose, numbers_[shape], pose, reach_m + kSkin_m, pairs_);
  std::stable_sort(pairs_.begin(), pairs_.end(),
                   [](const PointPair& a, const PointPair& b) { return a.gap_m < b.gap_m; });
  const Eigen::Isometry3d to_tool = tool_pose.inverse(Eigen::Isometry);
  for (const PointPair& p : pairs_) {
    if (out.size() >= kMostMeetings) break;
    if (!p.normal.allFinite() || !p.on_a_m.allFinite() || !p.on_b_m.allFinite()) continue;
    const Eigen::Vector3d normal = -p.normal, place = p.on_a_m - kSkin_m * normal, on_tool = to_tool * place;
    const bool known = std::any_of(out.begin(), out.end(), [&](const ToolMeeting& m) {
      return m.plane.normal.dot(normal) > same_direction_ && (m.tool_point_m - on_tool).norm() < kSamePlace_m;
    });
    if (known) continue;
    // Its height over the plane, whatever the detector calls the gap of two points that are not above each other.
    out.push_back({{p.on_b_m, normal, normal.dot(place - p.on_b_m), p.triangle_b}, on_tool});
  }
}

}  // namespace tactus::sim
