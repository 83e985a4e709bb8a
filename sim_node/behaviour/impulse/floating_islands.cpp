#include "sim_node/behaviour/impulse/floating_islands.h"

#include <Eigen/LU>
#include <algorithm>

namespace tactus::sim::impulse {
namespace {

// Bodies within this gap of a static body or a link exchange angular momentum with it, m.
constexpr double kNear_m = 1e-4;

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

}  // namespace

int FloatingIslands::root(int twist) {
  while (root_[slot(twist)] != twist) twist = root_[slot(twist)] = root_[slot(root_[slot(twist)])];
  return twist;
}

void FloatingIslands::find(const ContactRows& rows, std::span<const double> pushed) {
  members_.clear();
  if (std::none_of(pushed.begin(), pushed.end(), [](double p) { return p > 0; })) return;
  root_.resize(rows.inertias.size());
  for (const ContactPoint& p : rows.points) root_[slot(p.a)] = p.a, root_[slot(p.b)] = p.b;
  // Twist 0, of static bodies and links, is the root of all that do not float.
  const auto join = [&](int a, int b) {
    const int low = std::min(root(a), root(b)), high = std::max(root(a), root(b));
    root_[slot(high)] = low;
  };
  root_[0] = 0;
  for (std::size_t i = 0; i < rows.points.size(); ++i) {
    const ContactPoint& p = rows.points[i];
    const bool grounded = !p.a || !p.b;
    if (pushed[i] > 0 || (grounded && p.gap_m < kNear_m)) join(p.a, p.b);
  }
  for (std::size_t i = 0; i < rows.points.size(); ++i)
    for (const int twist : {rows.points[i].a, rows.points[i].b})
      if (pushed[i] > 0 && root(twist) != 0) members_.push_back({root(twist), twist});
  const auto order = [](const Member& a, const Member& b) { return a.root != b.root ? a.root < b.root : a.twist < b.twist; };
  std::sort(members_.begin(), members_.end(), order);
  const auto same = [](const Member& a, const Member& b) { return a.twist == b.twist; };
  members_.erase(std::unique(members_.begin(), members_.end(), same), members_.end());
}

void FloatingIslands::restore_spin() {
  double mass = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), lost = Eigen::Vector3d::Zero();
  for (const Body& b : island_) {
    mass += b.mass_kg;
    centre += b.mass_kg * b.centre_m;
    lost += b.lost_kg_m2_s;
  }
  centre /= mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Body& b : island_) {
    const Eigen::Vector3d r = b.centre_m - centre;
    inertia += b.inertia_kg_m2 + b.mass_kg * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  const Eigen::Vector3d rate = inertia.inverse() * lost;
  for (const Body& b : island_) {
    *b.velocity_m_s += rate.cross(b.centre_m - centre);
    *b.spin_rad_s += rate;
  }
}

}  // namespace tactus::sim::impulse
