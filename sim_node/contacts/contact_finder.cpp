#include "sim_node/contacts/contact_finder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim_node/collision/detectors/layer_options.h"
#include "sim_node/collision/gaps/select_points.h"
#include "sim_node/model/index.h"
#include "sync/time/phases.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kKinds = 7;
constexpr ShapeKind kAllKinds[kKinds] = {ShapeKind::kBox,        ShapeKind::kSphere, ShapeKind::kCylinder,
                                         ShapeKind::kCapsule,    ShapeKind::kPlane,  ShapeKind::kMesh,
                                         ShapeKind::kHeightfield};

std::size_t both(ShapeKind a, ShapeKind b) {
  return static_cast<std::size_t>(a) * kKinds + static_cast<std::size_t>(b);
}

ManifoldPoint point_of(const PointPair& p) {
  ManifoldPoint m;
  m.point_m = (p.on_a_m + p.on_b_m) / 2;
  m.normal = p.normal;
  m.depth_m = -p.gap_m;
  m.triangle_a = p.triangle_a, m.triangle_b = p.triangle_b;
  return m;
}

// Libraries report points without a normal where surfaces just touch.
bool is_sound(const PointPair& p) {
  return p.on_a_m.allFinite() && p.on_b_m.allFinite() && std::isfinite(p.gap_m) &&
         std::abs(p.normal.squaredNorm() - 1) < 1e-6;
}

}  // namespace

ContactFinder::ContactFinder(const WorldDef& world, const Settings& settings, std::shared_ptr<MeshTrees> trees)
    : near_(world, settings.contact_tolerance_m, *(trees = trees ? trees : std::make_shared<MeshTrees>())),
      friction_(world),
      passing_(world, settings.contact_tolerance_m),
      number_(world.shapes.size(), -1),
      chosen_number_(world.shapes.size(), -1) {
  const MeshContactOptions options = layer_options(settings);
  gaps_ = make_detector("gaps", options, trees);
  auto chosen = make_detector(settings.detector, options, trees);
  const DetectorAbilities can = chosen->abilities();
  if (!can.separation)
    throw std::runtime_error("sim_node: the detector \"" + settings.detector +
                             "\" reports no gaps, which the contact search needs; choose auto, gaps, layers, ccd or fcl");
  if (can.name != "gaps") chosen_ = std::move(chosen);
  only_triangles_ = can.name == "layers";
  chosen_supports_.resize(kKinds * kKinds, false);
  for (std::size_t i = 0; chosen_ && i < kKinds; ++i)
    for (const ShapeKind k : kAllKinds)
      chosen_supports_[both(kAllKinds[i], k)] = chosen_->unsupported_reason(kAllKinds[i], k).empty();
  for (std::size_t i = 0; i < world.shapes.size(); ++i) {
    const ShapeDef& shape = world.shapes[i];
    body_of_.push_back(shape.body);
    kinds_.push_back(shape.kind);
    if (world.bodies[index(shape.body)].tool >= 0) continue;
    number_[i] = gaps_->add(shape, world);
    if (chosen_ && chosen_supports_[both(shape.kind, shape.kind)]) chosen_number_[i] = chosen_->add(shape, world);
  }
}

void ContactFinder::detect_pair(const NearPair& pair, std::vector<Manifold>& out) {
  const std::size_t a = index(pair.shape_a), b = index(pair.shape_b);
  const auto query = [&](Detector& detector, const std::vector<int>& numbers) {
    detector.query(numbers[a], near_.pose(pair.shape_a), numbers[b], near_.pose(pair.shape_b), pair.reach_m,
                   pairs_);
  };
  const bool meshed = kinds_[a] == ShapeKind::kMesh || kinds_[b] == ShapeKind::kMesh ||
                      kinds_[a] == ShapeKind::kHeightfield || kinds_[b] == ShapeKind::kHeightfield;
  bool found = chosen_ && chosen_number_[a] >= 0 && chosen_number_[b] >= 0 &&
               chosen_supports_[both(kinds_[a], kinds_[b])] && (meshed || !only_triangles_);
  if (found) {
    query(*chosen_, chosen_number_);
    std::erase_if(pairs_, [](const PointPair& p) { return !is_sound(p); });
    found = std::none_of(pairs_.begin(), pairs_.end(), [](const PointPair& p) { return p.pierced; });
  }
  if (!found) {
    query(*gaps_, number_);
    std::erase_if(pairs_, [](const PointPair& p) { return !is_sound(p); });
  }
  if (pairs_.empty()) return;
  points_.clear();
  for (const PointPair& p : pairs_) points_.push_back(point_of(p));
  Manifold& m = out.emplace_back();
  m.shape_a = pair.shape_a, m.shape_b = pair.shape_b;
  m.body_a = body_of_[a], m.body_b = body_of_[b];
  gaps::select_points(points_, m);
  if (friction_.applies(m.shape_a, m.shape_b))
    friction_.apply(friction_.to_body(m.shape_a, near_.pose(m.shape_a)),
                   friction_.to_body(m.shape_b, near_.pose(m.shape_b)), m);
}

void ContactFinder::find(std::span<const BodyMotion> bodies, std::span<const int> active, double h_s,
                         std::vector<Manifold>& out) {
  const sync::ScopedPhaseTimer phase(sync::Phase::kCollision);
  out.clear();
  for (const NearPair& pair : near_.find(bodies, active, h_s)) {
    const std::size_t before = out.size();
    detect_pair(pair, out);
    if (out.size() == before) continue;
    Manifold& m = out.back();
    passing_.turn_normals(m, near_.pose(m.shape_a), bodies[index(m.body_a)], near_.pose(m.shape_b), bodies[index(m.body_b)], h_s);
  }
}

}  // namespace tactus::sim
