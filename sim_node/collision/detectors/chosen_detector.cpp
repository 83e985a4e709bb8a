#include "sim_node/collision/detectors/chosen_detector.h"

#include <algorithm>

#include "sim_node/collision/detectors/layer_options.h"

namespace tactus::sim {

ChosenDetector::ChosenDetector(const WorldDef& world, const Settings& settings) {
  for (const ShapeDef& s : world.shapes) kinds_.push_back(s.kind);
  number_.resize(world.shapes.size(), -1);
  // The ODE solver uses ODE's contacts by default.
  if (settings.detector == "ode" || settings.detector == "auto") return;
  detector_ = make_detector(settings.detector, layer_options(settings));
  triangles_only_ = settings.detector == "layers";
  if (detector_->abilities().separation) shell_m_ = settings.contact_tolerance_m;
  for (std::size_t i = 0; i < world.shapes.size(); ++i)
    if (kinds_[i] != ShapeKind::kHeightfield && detector_->unsupported_reason(kinds_[i], kinds_[i]).empty() &&
        world.bodies[static_cast<std::size_t>(world.shapes[i].body)].tool < 0)
      number_[i] = detector_->add(world.shapes[i], world);
}

bool ChosenDetector::supports(int a, int b) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  if (!detector_ || number_[i] < 0 || number_[j] < 0) return false;
  if (triangles_only_ && kinds_[i] != ShapeKind::kMesh && kinds_[j] != ShapeKind::kMesh) return false;
  return detector_->unsupported_reason(kinds_[i], kinds_[j]).empty();
}

bool ChosenDetector::query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b,
                           std::vector<ManifoldPoint>& out) {
  out.clear();
  detector_->query(number_[static_cast<std::size_t>(a)], pose_a, number_[static_cast<std::size_t>(b)], pose_b,
                   shell_m_, pairs_);
  if (std::any_of(pairs_.begin(), pairs_.end(), [](const PointPair& p) { return p.pierced; })) return false;
  patches_.make(pairs_, std::max(shell_m_, kSamePosition_m), patch_list_);
  for (const ContactPatch& patch : patch_list_)
    for (int i = 0; i < patch.count; ++i) {
      const PointPair& p = patch.points[static_cast<std::size_t>(i)];
      ManifoldPoint& m = out.emplace_back();
      m.point_m = (p.on_a_m + p.on_b_m) / 2;
      m.normal = p.normal;
      m.depth_m = shell_m_ - p.gap_m;
      m.triangle_a = p.triangle_a, m.triangle_b = p.triangle_b;
    }
  return true;
}

}  // namespace tactus::sim
