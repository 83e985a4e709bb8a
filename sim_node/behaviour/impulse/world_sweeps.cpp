// Contact in a step of a world: required speeds, first guesses, and sweeps over all points and joints.
#include <algorithm>
#include <cmath>

#include "sim_node/behaviour/impulse/world.h"

namespace tactus::sim::impulse {
namespace {

// A gap below which surfaces touch, m. Design value: five times the residual that the sweeps leave between resting
// surfaces.
constexpr double kWarmGap_m = 1e-5;
// Distance of a rotating surface from its linear path that is left to the correction of positions, m: a hundredth of the
// overlap that may remain.
constexpr double kNegligibleBend_m = 1e-7;

}  // namespace

// Distance along the normal by which the surfaces leave their linear path in this step, where that changes a contact:
// - Where a surface sinks below its linear path, it needs to rise first.
// - Where its path rises, the change of its spin without a torque (drift) may point downwards by as much. A force against
//   this drift alone would add energy.
double World::followed_bend_m(const ContactPoint& p, double h) const {
  double bend = rows_.path_bend_m(p, velocity_, h);
  if (bend > kNegligibleBend_m) {
    const auto drift_of = [&](int twist, const Eigen::Vector3d& arm) -> Eigen::Vector3d { return drift_.twists[index(twist)].angular_rad_s.cross(arm); };
    double drift = 0;
    if (p.b) drift += drift_of(p.b, p.arm_b).dot(p.axes.row(0));
    if (p.a) drift -= drift_of(p.a, p.arm_a).dot(p.axes.row(0));
    bend = std::min(bend, std::max(0.0, -h * drift));
  }
  return std::abs(bend) > kNegligibleBend_m ? bend : 0;
}

// Sets the minimum separating speeds: a gap closes at most to zero. Overlaps are corrected by positions, since a speed
// that is required between wedged surfaces may need any force. Only joints, which have no position offset, get it.
void World::set_required_speeds(double h) {
  const auto correction_speed = [&](double overlap) {
    return std::min(law_.max_correction_speed_m_s,
                    law_.correction_share * std::max(0.0, overlap - law_.slop_m) / h);
  };
  has_corrections_ = false;
  for (ContactPoint& p : rows_.points) {
    const double offset = rows_.velocity(p, position_offset_).x(), gap = p.gap_m + offset;
    if (p.couplings == 0) {
      p.min_speed_m_s = -std::max(0.0, gap) / h;
      // A surface that needs to rise does so at most at a speed at which the contact adds no energy: the speed at the
      // start of the step, which is the mean less the drift, is at most reversed.
      if (const double bend = followed_bend_m(p, h); bend != 0)
        p.min_speed_m_s = std::min(p.min_speed_m_s - bend / h, std::max(0.0, 2 * p.drift_m_s.x() - rows_.velocity(p, velocity_).x()));
      p.correction_m = h * correction_speed(-p.gap_m);
      has_corrections_ |= p.correction_m > 0 || gap < std::min(0.0, p.gap_m);
    } else if (p.gap_m >= 0 || gap >= 0) {
      p.min_speed_m_s = -gap / h;
    } else if (offset < 0) {
      p.min_speed_m_s = -offset / h + correction_speed(-p.gap_m);
    } else {
      p.min_speed_m_s = correction_speed(-gap);
    }
  }
}

// Bodies that were struck act from their offset places: otherwise later impulses of the step would change the angular
// momentum of a pair.
void World::shift_arms() {
  for (ContactPoint& p : rows_.points) {
    if (p.couplings > 0) continue;
    const Eigen::Vector3d a = position_offset_.twists[index(p.a)].linear_m_s, b = position_offset_.twists[index(p.b)].linear_m_s;
    if ((!p.a || a.isZero(0)) && (!p.b || b.isZero(0))) continue;
    const Eigen::Vector3d by = p.a && p.b ? Eigen::Vector3d((a + b) / 2) : p.a ? a : b;
    if (p.a) p.arm_a += by - a;
    if (p.b) p.arm_b += by - b;
    rows_.compute_mobility(p);
  }
}

// The impulse of the previous step is a guess only where the surfaces still touch: it left their gap at zero.
void World::limit_warm_start() {
  for (ContactPoint& p : rows_.points) p.impulse *= std::clamp(1 - p.gap_m / kWarmGap_m, 0.0, 1.0);
}

void World::sweep(double h) {
  const double settled_m_s = law_.convergence_m_s2 * h;
  before_contacts_.twists.resize(velocity_.twists.size());
  before_contacts_.rates.resize(velocity_.rates.size());
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      before_contacts_.twists[i + 1] = velocity_.twists[i + 1];
      continue;
    }
    const std::size_t s = i - free_.size();
    std::copy_n(velocity_.rates.data() + first_rate_[s], first_rate_[s + 1] - first_rate_[s], before_contacts_.rates.data() + first_rate_[s]);
  }
  for (const ContactPoint& p : rows_.points)
    if (p.impulse.x() > 0) rows_.apply(p, p.impulse, velocity_);
  for (const JointRow& row : joints_) apply(row, row.impulse, rows_.pool, velocity_);
  // Converged points are skipped until one of their sides changes.
  last_change_.resize(free_.size() + systems_.size() + 2);
  for (const ContactGroup& g : rows_.groups)
    for (const int moved : {g.mover_a, g.mover_b}) last_change_[index(moved + 1)] = 0;
  for (const JointRow& row : joints_) last_change_[index(row.mover + 1)] = 0;
  int visits = 0;
  const auto point = [&](ContactPoint& p) {
    int &a = last_change_[index(p.mover_a)], &b = last_change_[index(p.mover_b)];
    if (a <= p.visit && b <= p.visit) return 0.0;
    p.visit = visits;
    Eigen::Vector3d v = rows_.velocity(p, velocity_);
    v.x() -= p.min_speed_m_s;
    const Eigen::Vector3d next = ContactRows::solve_point(p, p.impulse, v);
    const Eigen::Vector3d by(next[0] - p.impulse[0], next[1] - p.impulse[1], next[2] - p.impulse[2]);
    const double change = std::max({std::abs(by[0]), std::abs(by[1]), std::abs(by[2])}) * p.mobility(0, 0);
    if (change == 0) return 0.0;
    p.impulse[0] = next[0], p.impulse[1] = next[1], p.impulse[2] = next[2];
    rows_.apply(p, by, velocity_);
    if (change >= settled_m_s) {
      ++visits;
      if (p.mover_a) a = visits;
      if (p.mover_b) b = visits;
    }
    return change;
  };
  const auto joint = [&](JointRow& row) {
    const double change = impulse::sweep(row, rows_.pool, velocity_);
    if (change >= settled_m_s) last_change_[index(row.mover + 1)] = ++visits;
    return change;
  };
  for (sweeps_ = 0; sweeps_ < law_.sweeps;) {
    double change = 0;
    const auto visit = [&](int number) { change = std::max(change, point(rows_.points[index(number)])); };
    for (JointRow& row : joints_) change = std::max(change, joint(row));
    const auto& order = layers_.points();
    // Alternates the direction, so that information travels through a stack both ways.
    if (sweeps_++ % 2 == 0)
      for (auto number = order.begin(); number != order.end(); ++number) visit(*number);
    else
      for (auto number = order.rbegin(); number != order.rend(); ++number) visit(*number);
    if (change < settled_m_s) {
      convergence_ = {change, 0, 0};
      return;
    }
  }
  convergence_ = {settled_m_s, 1, 0};
}

}  // namespace tactus::sim::impulse
