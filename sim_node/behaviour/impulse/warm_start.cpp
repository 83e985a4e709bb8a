#include "sim_node/behaviour/impulse/warm_start.h"

#include <algorithm>

namespace tactus::sim::impulse {
namespace {

// A point further than this from its previous position is a new point, m. Design value: well below the size of a
// patch, above the sliding distance of a step.
constexpr double kSame_m = 0.01;
// Points whose normals differ by more than 30 degrees belong to different faces, which may share a corner. Cosine.
constexpr double kSameNormal = 0.866;

Eigen::Vector3d place(const Manifold& m, const ManifoldPoint& p, std::span<const BodyMotion> poses) {
  const BodyMotion& b = poses[static_cast<std::size_t>(m.body_b)];
  return (b.moves() ? b : poses[static_cast<std::size_t>(m.body_a)]).to_body(p.point_m);
}

// The axes of a point change from step to step. A part outside the cone would be an impulse that no sweep has applied.
void limit_to_cone(ContactPoint& p) {
  p.impulse.x() = std::max(0.0, p.impulse.x());
  const double size = p.impulse.tail<2>().norm(), limit = p.friction * p.impulse.x();
  if (size > limit) p.impulse.tail<2>() *= limit / size;
}

}  // namespace

void WarmStart::recall(std::span<const Manifold> contacts, std::span<const BodyMotion> poses,
                       ContactRows& rows) const {
  auto stored = stored_.begin();
  for (const ContactGroup& g : rows.groups) {
    const Manifold& m = contacts[static_cast<std::size_t>(g.manifold)];
    const auto before = [&](const StoredPoint& k) {
      return k.shape_a != m.shape_a ? k.shape_a < m.shape_a : k.shape_b < m.shape_b;
    };
    while (stored != stored_.end() && before(*stored)) ++stored;
    for (int i = 0; i < g.count; ++i) {
      ContactPoint& p = rows.points[static_cast<std::size_t>(g.first + i)];
      const Eigen::Vector3d here = place(m, m.points[static_cast<std::size_t>(i)], poses);
      double nearest = kSame_m * kSame_m;
      for (auto k = stored; k != stored_.end() && k->shape_a == m.shape_a && k->shape_b == m.shape_b; ++k) {
        const double apart = (k->position_m - here).squaredNorm();
        if (apart >= nearest || k->normal.dot(p.axes.row(0)) < kSameNormal) continue;
        nearest = apart;
        p.impulse = p.force_time_s * (p.axes * k->force_N);
        p.shell_m = k->shell_m;
      }
      limit_to_cone(p);
    }
  }
}

void WarmStart::store(std::span<const Manifold> contacts, std::span<const BodyMotion> poses,
                     const ContactRows& rows) {
  stored_.clear();
  for (const ContactGroup& g : rows.groups) {
    const Manifold& m = contacts[static_cast<std::size_t>(g.manifold)];
    for (int i = 0; i < g.count; ++i) {
      const ContactPoint& p = rows.points[static_cast<std::size_t>(g.first + i)];
      if (p.impulse.x() <= 0 && p.penalty_force == PenaltyForce::kNone) continue;
      stored_.push_back({m.shape_a, m.shape_b, place(m, m.points[static_cast<std::size_t>(i)], poses), p.axes.row(0),
                       p.axes.transpose() * p.impulse / p.force_time_s, p.shell_m});
    }
  }
}

}  // namespace tactus::sim::impulse
