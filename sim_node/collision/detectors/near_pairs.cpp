#include "sim_node/collision/detectors/near_pairs.h"

#include <algorithm>
#include <limits>

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/model/index.h"

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

// Maximum length of a chain of impacts in which each body is hit by the one before. Design value: beyond it most of
// the impact is spent.
constexpr int kMaxImpacts = 8;
// Factor for friction, which adds at most the same speed in the tangent plane, for coefficients up to 1. For
// larger coefficients, impulse::AdaptiveStepper detects that a body moved further than the search assumed.
constexpr double kWithFriction = 2;

}  // namespace

NearPairs::Extent NearPairs::extent_of(const ShapeDef& shape, const WorldDef& world, MeshTrees& trees) {
  Extent e;
  if (shape.kind == ShapeKind::kMesh || shape.kind == ShapeKind::kHeightfield) {
    const auto tree = trees.triangles(shape, world);
    if (tree->empty()) return e;
    e.middle_m = tree->box().center();
    e.half_m = 0.5 * tree->box().sizes();
    return e;
  }
  const gaps::Convex c = gaps::convex_of(shape);
  e.half_m = c.half_m;
  e.round_m = c.round_m;
  if (shape.kind == ShapeKind::kPlane) e.middle_m = gaps::plate_offset().translation();
  return e;
}

NearPairs::NearPairs(const WorldDef& world, double tolerance_m, MeshTrees& trees)
    : tolerance_m_(tolerance_m),
      gravity_m_s2_(world.gravity_m_s2.norm()),
      half_space_of_(world.shapes.size(), -1),
      impact_speed_m_s_(world.bodies.size(), 0.0),
      shapes_of_(world.bodies.size()) {
  std::vector<Bounds> fixed;
  for (std::size_t i = 0; i < world.shapes.size(); ++i) {
    const ShapeDef& shape = world.shapes[i];
    const BodyDef& body = world.bodies[index(shape.body)];
    const int number = static_cast<int>(i);
    body_of_.push_back(shape.body);
    restitution_.push_back(shape.restitution);
    in_body_.push_back(Eigen::Translation3d(-body.centre_of_mass_m) * shape.pose);
    poses_.push_back(body.pose * shape.pose);
    const bool ghost = body.tool >= 0;
    Extent& e = extents_.emplace_back(ghost ? Extent{} : extent_of(shape, world, trees));
    e.lever_m = (in_body_.back() * e.middle_m).norm() + e.half_m.norm();
    if (ghost) continue;
    if (!body.is_static) {
      shapes_of_[index(shape.body)].push_back(number);
    } else if (shape.kind == ShapeKind::kPlane) {
      const Vector3d n = poses_.back().linear().col(2).normalized();
      half_space_of_[i] = static_cast<int>(half_spaces_.size());
      half_spaces_.push_back({number, n, n.dot(poses_.back().translation())});
    } else {
      fixed_.push_back(number);
      fixed.push_back(bounds_of_shape(number));
    }
  }
  grid_.build(fixed);
  for (const auto& [a, b] : world.no_collision) excluded_pairs_.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(excluded_pairs_.begin(), excluded_pairs_.end());
}

Bounds NearPairs::bounds_of_shape(int shape) const {
  const Extent& e = extents_[index(shape)];
  const Eigen::Isometry3d& pose = poses_[index(shape)];
  const Vector3d middle = pose * e.middle_m;
  const Vector3d half = (pose.linear().cwiseAbs() * e.half_m).array() + e.round_m;
  return {middle - half, middle + half};
}

bool NearPairs::may_touch(int a, int b) const {
  return a != b && !std::binary_search(excluded_pairs_.begin(), excluded_pairs_.end(),
                                       std::pair(std::min(a, b), std::max(a, b)));
}

// How far rotation of its body may move a point of the shape.
double NearPairs::rotation_reach_m(const BodyMotion& m, int shape, double h) const {
  return m.spin_rad_s.norm() * extents_[index(shape)].lever_m * h;
}

void NearPairs::add(int a, int b, double reach_m) {
  if (body_of_[index(a)] > body_of_[index(b)]) std::swap(a, b);
  pairs_.push_back({a, b, reach_m});
}

void NearPairs::place(const BodyMotion& m, int body, double h) {
  Eigen::Isometry3d about = Eigen::Isometry3d::Identity();
  about.linear() = m.orientation.toRotationMatrix();
  about.translation() = m.centre_m;
  for (const int shape : shapes_of_[index(body)]) {
    poses_[index(shape)] = about * in_body_[index(shape)];
    Swept& s = swept_.emplace_back(Swept{shape, body, bounds_of_shape(shape)});
    const Vector3d displacement = h * m.velocity_m_s;
    const double isotropic = rotation_reach_m(m, shape, h) + gravity_m_s2_ * h * h + tolerance_m_ / 2;
    s.bounds.min_m += (displacement.array().min(0) - isotropic).matrix();
    s.bounds.max_m += (displacement.array().max(0) + isotropic).matrix();
  }
}

void NearPairs::pair_with_fixed(std::size_t i, std::span<const BodyMotion> bodies, double h) {
  const Swept& s = swept_[i];
  const BodyMotion& m = bodies[index(s.body)];
  const double reach = (m.velocity_m_s.norm() + impact_speed_m_s_[index(s.body)]) * h + rotation_reach_m(m, s.shape, h) +
                       gravity_m_s2_ * h * h + tolerance_m_;
  const Vector3d middle = (s.bounds.min_m + s.bounds.max_m) / 2, half = (s.bounds.max_m - s.bounds.min_m) / 2;
  for (const HalfSpace& p : half_spaces_)
    if (p.normal.dot(middle) - p.normal.cwiseAbs().dot(half) - p.offset_m <= tolerance_m_ / 2 &&
        may_touch(s.body, body_of_[index(p.shape)]))
      add(s.shape, p.shape, reach);
  if (fixed_.empty()) return;
  grid_hits_.clear();
  const Vector3d more = Vector3d::Constant(tolerance_m_ / 2);
  grid_.find({s.bounds.min_m - more, s.bounds.max_m + more}, grid_hits_);
  for (const int at : grid_hits_)
    if (may_touch(s.body, body_of_[index(fixed_[index(at)])])) add(s.shape, fixed_[index(at)], reach);
}

// Sorts along the axis of the largest spread. The order hardly changes from step to step.
void NearPairs::order_swept() {
  Vector3d sum(0, 0, 0), squares(0, 0, 0);
  for (const Swept& s : swept_) {
    sum += s.bounds.min_m;
    squares += s.bounds.min_m.cwiseAbs2();
  }
  Eigen::Index axis = 0;
  (static_cast<double>(swept_.size()) * squares - sum.cwiseAbs2()).maxCoeff(&axis);
  const bool known = order_.size() == swept_.size();
  order_.resize(swept_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    Span& o = order_[k];
    if (!known) o.swept = k;
    o.min_m = swept_[o.swept].bounds.min_m[axis], o.max_m = swept_[o.swept].bounds.max_m[axis];
  }
  const auto before = [](const Span& x, const Span& y) {
    return x.min_m != y.min_m ? x.min_m < y.min_m : x.swept < y.swept;
  };
  std::size_t moves = 0;
  for (std::size_t k = 1; k < order_.size() && moves < 4 * order_.size(); ++k)
    for (std::size_t i = k; i > 0 && before(order_[i], order_[i - 1]); --i, ++moves)
      std::swap(order_[i], order_[i - 1]);
  if (moves >= 4 * order_.size()) std::sort(order_.begin(), order_.end(), before);
}

void NearPairs::pair_moving(std::span<const BodyMotion> bodies, double h) {
  order_swept();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Swept& s = swept_[order_[i].swept];
    for (std::size_t j = i + 1; j < order_.size() && order_[j].min_m <= order_[i].max_m; ++j) {
      const Swept& t = swept_[order_[j].swept];
      if (!s.bounds.overlaps(t.bounds) || !may_touch(s.body, t.body)) continue;
      const BodyMotion &m = bodies[index(s.body)], &n = bodies[index(t.body)];
      add(s.shape, t.shape,
          ((m.velocity_m_s - n.velocity_m_s).norm() + impact_speed_m_s_[index(s.body)] + impact_speed_m_s_[index(t.body)]) * h +
              rotation_reach_m(m, s.shape, h) + rotation_reach_m(n, t.shape, h) + gravity_m_s2_ * h * h + tolerance_m_);
    }
  }
}

// Updates the speed that impacts of the detected pairs may add. Returns true when a bound grows so much that other
// bodies come within reach. An impact acts between two centres by Newton's law; with a static body it is a bounce.
bool NearPairs::add_impacts(std::span<const BodyMotion> bodies, std::span<const int> active, double h) {
  double fastest = 0;
  for (const int body : active) fastest = std::max(fastest, bodies[index(body)].velocity_m_s.norm());
  bool more = false;
  // Approach speed of a shape of a body to a half space. The normal is known, so tangential motion causes no impact.
  const auto approach_speed = [&](int fixed, const BodyMotion& m, int shape) {
    const int half_space = half_space_of_[index(fixed)];
    if (half_space < 0) return std::numeric_limits<double>::infinity();
    return std::max(0.0, -half_spaces_[index(half_space)].normal.dot(m.velocity_m_s)) +
           m.spin_rad_s.norm() * extents_[index(shape)].lever_m;
  };
  const auto add_impact = [&](int body, const BodyMotion& of, const BodyMotion& by, double add_m_s, double e,
                       double closing_m_s) {
    const double masses = of.inverse_mass_1_kg + by.inverse_mass_1_kg;
    const double share = masses > 0 ? of.inverse_mass_1_kg / masses : 1;
    const double speed = (of.velocity_m_s - by.velocity_m_s).norm() + add_m_s;
    double& known = impact_speed_m_s_[index(body)];
    const double impact =
        std::min({(1 + e) * share * speed, 2 * fastest, kWithFriction * (1 + e) * (closing_m_s + known)});
    if ((impact - known) * h <= tolerance_m_ / 4) return;
    known = impact;
    more = true;
  };
  static const BodyMotion kFixed;
  for (const NearPair& p : pairs_) {
    const int a = body_of_[index(p.shape_a)], b = body_of_[index(p.shape_b)];
    const double e = std::min(restitution_[index(p.shape_a)], restitution_[index(p.shape_b)]);
    const bool moves_a = !shapes_of_[index(a)].empty(), moves_b = !shapes_of_[index(b)].empty();
    const BodyMotion &m = moves_a ? bodies[index(a)] : kFixed, &n = moves_b ? bodies[index(b)] : kFixed;
    const double before_a = impact_speed_m_s_[index(a)], before_b = impact_speed_m_s_[index(b)];
    if (moves_a) add_impact(a, m, n, before_b, e, approach_speed(p.shape_b, m, p.shape_a));
    if (moves_b) add_impact(b, n, m, before_a, e, approach_speed(p.shape_a, n, p.shape_b));
  }
  if (!more) return false;
  for (Swept& s : swept_) {
    const double grow = impact_speed_m_s_[index(s.body)] * h - s.grown_m;
    s.bounds.min_m.array() -= grow;
    s.bounds.max_m.array() += grow;
    s.grown_m += grow;
  }
  return true;
}

std::span<const NearPair> NearPairs::find(std::span<const BodyMotion> bodies, std::span<const int> active,
                                          double h) {
  swept_.clear();
  for (const int body : active) {
    impact_speed_m_s_[index(body)] = 0;
    place(bodies[index(body)], body, h);
  }
  for (int round = 0;; ++round) {
    pairs_.clear();
    for (std::size_t i = 0; i < swept_.size(); ++i) pair_with_fixed(i, bodies, h);
    pair_moving(bodies, h);
    if (round == kMaxImpacts || !add_impacts(bodies, active, h)) break;
  }
  const auto before = [](const NearPair& x, const NearPair& y) {
    return x.shape_a != y.shape_a ? x.shape_a < y.shape_a : x.shape_b < y.shape_b;
  };
  if (!std::is_sorted(pairs_.begin(), pairs_.end(), before)) std::sort(pairs_.begin(), pairs_.end(), before);
  return pairs_;
}

}  // namespace tactus::sim
