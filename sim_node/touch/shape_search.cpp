#include "sim_node/touch/shape_search.h"

#include <algorithm>
#include <cmath>

#include "sim_node/collision/detectors/layer_options.h"
#include "sim_node/collision/nearest_first.h"
#include "sim_node/model/tool_shape.h"

namespace tactus::sim {
namespace {

// Per surface, the nearest ones; more than the touch model holds for all surfaces.
constexpr std::size_t kMaxPairs = 64;

// Keeps the nearest pair for each place and direction.
class ToolPairCollector : public PairVisitor {
 public:
  ToolPairCollector(double same_direction, const Eigen::Isometry3d& to_tool, std::vector<ToolPointPair>& out)
      : same_direction_(same_direction), to_tool_(to_tool), out_(out) {}

  bool is_redundant(const PointPair& p) const override {
    if (!p.normal.allFinite() || !p.on_a_m.allFinite() || !p.on_b_m.allFinite()) return true;
    const Eigen::Vector3d normal = -p.normal, on_tool = to_tool_ * place(p);
    return std::any_of(out_.begin(), out_.end(), [&](const ToolPointPair& m) {
      return m.plane.normal.dot(normal) > same_direction_ &&
             (m.tool_point_m - on_tool).norm() < ShapeSearch::kSamePosition_m;
    });
  }

  bool visit(const PointPair& p) override {
    // The height over the plane: the detector's gap differs for points that are not above each other.
    const Eigen::Vector3d normal = -p.normal;
    out_.push_back({{p.on_b_m, normal, normal.dot(place(p) - p.on_b_m), p.triangle_b}, to_tool_ * place(p)});
    return out_.size() < kMaxPairs;
  }

 private:
  static Eigen::Vector3d place(const PointPair& p) { return p.on_a_m + ShapeSearch::kSkin_m * p.normal; }

  double same_direction_;
  Eigen::Isometry3d to_tool_;
  std::vector<ToolPointPair>& out_;
};

}  // namespace

ShapeSearch::ShapeSearch(const WorldDef& world, int tool, const Settings& settings, MeshTrees& trees)
    : same_direction_(std::cos(settings.touch_merge_angle_rad)),
      detector_(make_gaps_detector(layer_options(settings),
                                   std::shared_ptr<MeshTrees>(std::shared_ptr<void>(), &trees))),
      tool_(detector_->add(tool_shape(world.tools[static_cast<std::size_t>(tool)]), world)) {}

void ShapeSearch::add(const ShapeDef& shape, const WorldDef& world) {
  detector_ids_.push_back(detector_->add(shape, world));
  prepare_nearest_first(*detector_, tool_, detector_ids_.back());
}

void ShapeSearch::query(std::size_t shape, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& tool_pose,
                        double reach_m, std::vector<ToolPointPair>& out) {
  out.clear();
  ToolPairCollector meetings(same_direction_, tool_pose.inverse(Eigen::Isometry), out);
  nearest_first(*detector_, tool_, tool_pose, detector_ids_[shape], pose, reach_m + kSkin_m, meetings, pairs_);
}

}  // namespace tactus::sim
