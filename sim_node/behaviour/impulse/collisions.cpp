#include "sim_node/behaviour/impulse/collisions.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tactus::sim::impulse {
namespace {

// Sweeps over the points of one pair, and the change of speed at which they have converged, m/s.
constexpr int kMaxSweeps = 50;
constexpr double kSettled_m_s = 1e-12;
// Impacts per group and step: a row of n balls needs up to n/2 each. The contact solver handles the rest.
constexpr std::size_t kMaxImpacts = 16;
// Gaps below this count as zero: the residual of the sweeps, m.
constexpr double kTouching_m = 2e-6;
// Points whose normals are within 30 degrees belong to one face. Cosine.
constexpr double kSameImpactFace = 0.866;
// Impacts within this share of a step happen at the same time: rounding of gaps.
constexpr double kSameTime = 1e-6;
// Rounding of an energy, as a share of the energies that impulses take and return.
constexpr double kRounding = 1e-12;

std::array<Eigen::Vector3d, kMaxManifoldPoints> zero_impulses() {
  std::array<Eigen::Vector3d, kMaxManifoldPoints> out;
  out.fill(Eigen::Vector3d::Zero());
  return out;
}

}  // namespace

// Calls each(velocity, pointer to its offset or null) for every velocity component of a mover.
template <class F>
void Collisions::for_each_component(int mover, F&& each) {
  if (mover < 0) return;
  const auto m = static_cast<std::size_t>(mover);
  if (m < velocity_->twists.size()) {
    Twist &v = velocity_->twists[m], &x = position_offset_->twists[m];
    for (int k = 0; k < 3; ++k) each(v.linear_m_s[k], &x.linear_m_s[k]);
    for (int k = 0; k < 3; ++k) each(v.angular_rad_s[k], &x.angular_rad_s[k]);
    return;
  }
  const std::size_t system = m - velocity_->twists.size();
  for (std::size_t i = (*first_rate_)[system]; i < (*first_rate_)[system + 1]; ++i)
    each(velocity_->rates[i], nullptr);
}

// Solves gap + s t + (drift / h) t^2 = 0: the drift grows linearly over the step, so half of it is in the mean.
bool Collisions::will_touch(const ContactPoint& p, PredictedImpact& out) const {
  const double gap = p.gap_m + rows_->velocity(p, *position_offset_).x();
  const double speed = rows_->velocity(p, *velocity_).x(), bend = p.drift_m_s.x() / h_;
  double t = 0;
  if (gap < 0 && -gap > -1.5 * speed * h_) {
    // The overlap is older than the last step: the impact is at t = 0.
    if (speed >= 0) return false;
  } else {
    const double inside = speed * speed - 4 * bend * gap;
    if (inside < 0) return false;
    const double root = std::sqrt(inside);
    if (speed < 0)
      t = 2 * gap / (-speed + root);
    else if (bend < 0)
      t = (speed + root) / (-2 * bend);
    else
      return false;
    if (t > h_) return false;
    t = std::max(t, -h_);
  }
  out = {t, -(speed + 2 * bend * t)};
  return true;
}

// Speed gained within a step, by gravity or since a rotating surface leaves its linear path, is not a collision.
bool Collisions::will_collide(const ContactPoint& p, PredictedImpact& out) const {
  if (!will_touch(p, out)) return false;
  const double drift = p.drift_m_s.x(), least = limits_.bounce_speed_m_s + 2 * std::abs(drift);
  if (out.speed_m_s <= least || p.gap_m > kTouching_m) return out.speed_m_s > least;
  const double bend = std::min(0.0, rows_->path_bend_m(p, *velocity_, h_));
  return out.speed_m_s > limits_.bounce_speed_m_s + 2 * std::max(std::abs(drift), std::abs(drift + bend / h_));
}

// The speed is 0 when the pair does not collide. The time is that of its first point.
Collisions::PredictedImpact Collisions::approach(const ContactGroup& g) const {
  if (g.spring_only) return {};
  double fastest = 0, on_new_face = 0, first = h_;
  bool overlaps = false;
  const auto points = std::span(rows_->points).subspan(static_cast<std::size_t>(g.first), static_cast<std::size_t>(g.count));
  for (const ContactPoint& p : points) {
    PredictedImpact m;
    overlaps |= p.gap_m < 0;
    if (!will_collide(p, m)) continue;
    fastest = std::max(fastest, m.speed_m_s);
    first = std::min(first, m.time_s);
    const bool known = g.impacts > 0 && std::any_of(points.begin(), points.end(), [&](const ContactPoint& q) {
      return q.impact_N_s > 0 && q.axes.row(0).dot(p.axes.row(0)) > kSameImpactFace;
    });
    if (!known) on_new_face = std::max(on_new_face, m.speed_m_s);
  }
  if (g.restitution > 0 || overlaps) return {first, fastest};
  // Joints get no offset. In front of them the contact solver lets the gap close to zero.
  const int twists = static_cast<int>(velocity_->twists.size());
  return {first, g.mover_a < twists && g.mover_b < twists ? on_new_face : 0};
}

// Predicts the meeting of a pair without impact from its free motion, when its gap is open.
void Collisions::predict_impact(ContactGroup& g) const {
  g.first_s = h_;
  for (int i = 0; i < g.count; ++i) {
    PredictedImpact m;
    const ContactPoint& p = rows_->points[static_cast<std::size_t>(g.first + i)];
    if (p.gap_m < kTouching_m) {
      g.first_impact_point = -1;
      return;
    }
    if (!will_touch(p, m) || (g.first_impact_point >= 0 && m.time_s >= g.first_s)) continue;
    g.first_impact_point = i;
    g.first_s = g.last_s = std::max(0.0, m.time_s);
    g.speed_m_s = m.speed_m_s;
  }
}

// Sweeps over the points that take part, at the time t, until no impulse changes. wanted: separating speeds; null: zero.
void Collisions::solve_impact(const ContactGroup& g, double t, const double* wanted, PointImpulses& impulse) {
  for (int round = 0; round < kMaxSweeps; ++round) {
    double change = 0;
    for (int i = 0; i < g.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!takes_part_[k]) continue;
      const ContactPoint& p = rows_->points[static_cast<std::size_t>(g.first + i)];
      Eigen::Vector3d v = rows_->velocity(p, *velocity_) + 2 * t / h_ * p.drift_m_s;
      if (wanted) v.x() -= wanted[k];
      const Eigen::Vector3d next = ContactRows::solve(p, impulse[k], v), by = next - impulse[k];
      impulse[k] = next;
      rows_->apply(p, by, *velocity_);
      change = std::max(change, by.norm() * p.mobility(0, 0));
    }
    if (change < kSettled_m_s) break;
  }
}

// The share of the way from the impulses of compression to those of restitution at which the pair has at most the
// kinetic energy from before. The velocities are those with the impulses of restitution. With impulses J the energy
// changes by the sum of J (u + u') / 2, u before and u' after them, which is a quadratic function of the share.
double Collisions::passive_share(const ContactGroup& g, double t, const PointImpulses& compression, const PointImpulses& restitution) {
  double constant = 0, slope = 0, curve = 0, size = 0;
  const auto point = [&](int i) -> const ContactPoint& { return rows_->points[static_cast<std::size_t>(g.first + i)]; };
  PointImpulses last = zero_impulses(), middle = last, first = last;
  const auto velocities = [&](PointImpulses& out) {
    for (int i = 0; i < g.count; ++i)
      out[static_cast<std::size_t>(i)] = rows_->velocity(point(i), *velocity_) + 2 * t / h_ * point(i).drift_m_s;
  };
  const auto move = [&](const PointImpulses& from, const PointImpulses& to) {
    for (int i = 0; i < g.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (takes_part_[k]) rows_->apply(point(i), to[k] - from[k], *velocity_);
    }
  };
  const PointImpulses none = zero_impulses();
  velocities(last);
  move(restitution, compression);
  velocities(middle);
  move(compression, none);
  velocities(first);
  move(none, restitution);
  for (int i = 0; i < g.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!takes_part_[k]) continue;
    const Eigen::Vector3d by = restitution[k] - compression[k], opens = last[k] - middle[k];
    constant += compression[k].dot(first[k] + middle[k]) / 2;
    slope += by.dot(first[k] + middle[k]) / 2 + compression[k].dot(opens) / 2;
    curve += by.dot(opens) / 2;
    size += std::abs(restitution[k].dot(first[k])) + std::abs(restitution[k].dot(last[k]));
  }
  if (constant + slope + curve <= kRounding * size) return 1;
  // The larger root of constant + slope s + curve s^2, with constant <= 0.
  const double below = std::max(0.0, slope * slope - 4 * curve * std::min(0.0, constant));
  return curve > 0 ? std::clamp((-slope + std::sqrt(below)) / (2 * curve), 0.0, 1.0) : 0;
}

// Moves a pair to its poses and velocities at the time of its impact: arms, inertias and mobilities. Both sides get one
// point of action, so that the impulses keep the angular momentum. Normals stay those of the start.
void Collisions::move_to(ContactGroup& g, double t) {
  const auto begin = rows_->points.begin() + g.first;
  start_points_.assign(begin, begin + g.count);
  const auto twist_of = [&](int mover) { return mover >= 0 && static_cast<std::size_t>(mover) < velocity_->twists.size() ? mover : 0; };
  moved_[0].twist = twist_of(g.mover_a), moved_[1].twist = twist_of(g.mover_b);
  // Joints receive impulses at the start of the step.
  if (std::any_of(begin, begin + g.count, [](const ContactPoint& p) { return p.couplings > 0; })) moved_[0].twist = moved_[1].twist = 0;
  for (MovedBody& m : moved_) {
    if (!m.twist) continue;
    const auto i = static_cast<std::size_t>(m.twist);
    Twist& v = velocity_->twists[i];
    const Twist &x = position_offset_->twists[i], &drift = drift_->twists[i];
    m.start = v;
    m.shift_m = t * (v.linear_m_s + t / h_ * drift.linear_m_s) + x.linear_m_s;
    m.turn_rad = t * (v.angular_rad_s + t / h_ * drift.angular_rad_s) + x.angular_rad_s;
    const double angle = m.turn_rad.norm();
    m.rotation.setIdentity();
    if (angle > 0) m.rotation = Eigen::AngleAxisd(angle, m.turn_rad / angle).toRotationMatrix();
    Eigen::Matrix3d& inverse = rows_->inertias[i].inverse_inertia;
    m.start_inverse_inertia = inverse;
    inverse = m.rotation * inverse * m.rotation.transpose();
    m.inertia = inverse.inverse();
    v.linear_m_s += 2 * t / h_ * drift.linear_m_s;
    v.angular_rad_s = inverse * (m.start_inverse_inertia.inverse() * v.angular_rad_s);
    m.struck = v;
  }
  if (!moved_[0].twist && !moved_[1].twist) return;
  for (int i = 0; i < g.count; ++i) {
    ContactPoint& p = rows_->points[static_cast<std::size_t>(g.first + i)];
    p.drift_m_s.setZero();
    Eigen::Vector3d by = Eigen::Vector3d::Zero();
    if (p.a) by += (moved_[0].shift_m + g.round_a.displacement_m(p.arm_a, moved_[0].turn_rad)) / 2;
    if (p.b) by += (moved_[1].shift_m + g.round_b.displacement_m(p.arm_b, moved_[1].turn_rad)) / 2;
    // Beside a static surface the point is on the moving one. It was found in the middle of the gap.
    if (!p.a || !p.b) by = 2 * by + (p.b ? 0.5 : -0.5) * (p.gap_m + limits_.shell_m) * p.axes.row(0).transpose();
    if (p.a) p.arm_a += by - moved_[0].shift_m;
    if (p.b) p.arm_b += by - moved_[1].shift_m;
    rows_->compute_mobility(p);
  }
}

// Returns to the start of the step. Changes of linear and angular momentum stay what they were.
void Collisions::move_back(ContactGroup& g, double t) {
  if (!moved_[0].twist && !moved_[1].twist) return;
  for (int i = 0; i < g.count; ++i) {
    ContactPoint& p = rows_->points[static_cast<std::size_t>(g.first + i)];
    const ContactPoint& start = start_points_[static_cast<std::size_t>(i)];
    p.arm_a = start.arm_a, p.arm_b = start.arm_b;
    p.drift_m_s = start.drift_m_s;
    p.mobility = start.mobility, p.inverse_mobility = start.inverse_mobility, p.sliding_mobility = start.sliding_mobility;
  }
  for (const MovedBody& m : moved_) {
    if (!m.twist) continue;
    const auto i = static_cast<std::size_t>(m.twist);
    Twist& v = velocity_->twists[i];
    v.linear_m_s = m.start.linear_m_s + (v.linear_m_s - m.struck.linear_m_s);
    v.angular_rad_s = m.start.angular_rad_s + m.start_inverse_inertia * (m.inertia * (v.angular_rad_s - m.struck.angular_rad_s));
    rows_->inertias[i].inverse_inertia = m.start_inverse_inertia;
    // An impact that is found later but happened earlier is taken to have happened with the last one.
    if (t >= blows_[i].last.time_s) blows_[i].last = {t, m.turn_rad};
    if (t < 0 && blows_[i].last.time_s < 0) blows_[i].last = {0, Eigen::Vector3d::Zero()};
  }
}

void Collisions::apply_collision(ContactGroup& g) {
  PointImpulses impulse = zero_impulses();
  std::array<double, kMaxManifoldPoints> wanted{};
  PredictedImpact first{h_, 0}, m;
  const auto point = [&](int i) -> ContactPoint& { return rows_->points[static_cast<std::size_t>(g.first + i)]; };
  const int count = std::min(g.count, kMaxManifoldPoints);
  int struck = 0;
  for (int i = 0; i < count; ++i)
    if (will_collide(point(i), m) && m.time_s < first.time_s) {
      first = m;
      struck = i;
    }
  const double t = first.time_s;
  std::array<double, kMaxManifoldPoints> closing{};
  for (int i = 0; i < count; ++i) {
    const ContactPoint& p = point(i);
    const auto k = static_cast<std::size_t>(i);
    const double mean = rows_->velocity(p, *velocity_).x() + t / h_ * p.drift_m_s.x();
    const double gap = p.gap_m + rows_->velocity(p, *position_offset_).x() + t * mean;
    takes_part_[k] = gap < limits_.touching_m;
    impulse[k].setZero();
  }
  before_.clear();
  const auto keep = [this](double v, const double*) { before_.push_back(v); };
  for_each_component(g.mover_a, keep);
  if (g.mover_b != g.mover_a) for_each_component(g.mover_b, keep);
  move_to(g, t);
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    closing[k] = -(rows_->velocity(point(i), *velocity_).x() + 2 * t / h_ * point(i).drift_m_s.x());
    wanted[k] = std::max(0.0, g.restitution * closing[k]);
  }
  // Compression: the impulses that stop the approach. They take energy at any friction.
  solve_impact(g, t, nullptr, impulse);
  if (g.restitution > 0) {
    // Restitution, Newton's law: it may add energy where friction stops or reverses the sliding (Kane and Levinson 1985,
    // Stronge 1991). Along the line from the one solution to the other, energy is convex, and impulses stay within their
    // cones: the largest share is taken that leaves no more energy than before.
    const std::array<Eigen::Vector3d, kMaxManifoldPoints> compression = impulse;
    solve_impact(g, t, wanted.data(), impulse);
    const double share = passive_share(g, t, compression, impulse);
    if (share < 1)
      for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!takes_part_[k]) continue;
        const Eigen::Vector3d by = (share - 1) * (impulse[k] - compression[k]);
        impulse[k] += by;
        rows_->apply(point(i), by, *velocity_);
      }
  }
  move_back(g, t);
  report_impact(g, t, struck, closing, impulse);
  for (int i = 0; i < count; ++i) point(i).impact_N_s += impulse[static_cast<std::size_t>(i)].x();
  // Joints get no offset: their momentum depends on their positions, so they receive the impulse at the start of the
  // step.
  std::size_t next = 0;
  const auto add_position_offset = [&](double v, double* x) {
    const double change = v - before_[next++];
    if (x) *x -= t * change;
  };
  for_each_component(g.mover_a, add_position_offset);
  if (g.mover_b != g.mover_a) for_each_component(g.mover_b, add_position_offset);
  for (const MovedBody& m : moved_)
    if (m.twist) blows_[static_cast<std::size_t>(m.twist)].offset_rad = position_offset_->twists[static_cast<std::size_t>(m.twist)].angular_rad_s;
}

// Stores the impact with the highest speed of the step: on a mesh it may be on another face than the first. struck: the
// point that met first. Where it takes no impulse, the impact is at the fastest of the points that do.
void Collisions::report_impact(ContactGroup& g, double t, int struck, const std::array<double, kMaxManifoldPoints>& closing, const PointImpulses& impulse) const {
  const double time = std::max(0.0, t);
  ++g.impacts;
  g.last_s = std::max(g.last_s, time);
  int at = struck;
  for (int i = 0; i < g.count; ++i) {
    const auto k = static_cast<std::size_t>(i), best = static_cast<std::size_t>(at);
    if (takes_part_[k] && impulse[k].x() > 0 && (impulse[best].x() <= 0 || closing[k] > closing[best])) at = i;
  }
  const double speed = closing[static_cast<std::size_t>(at)];
  if (g.impacts > 1 && speed <= g.speed_m_s) return;
  g.first_impact_point = at;
  g.first_s = time;
  g.speed_m_s = speed;
}

// The next pair to collide: the one that meets first, and of those that meet at the same time the fastest. An impact that is
// resolved after a later one of the same body would happen on a path that the body has not taken, and could add energy.
// -1: none.
int Collisions::next_impact() const {
  int next = -1;
  for (std::size_t i = 0; i < approach_.size(); ++i) {
    const PredictedImpact& m = approach_[i];
    if (m.speed_m_s <= 0) continue;
    if (next >= 0) {
      const PredictedImpact& best = approach_[static_cast<std::size_t>(next)];
      const double later = m.time_s - best.time_s;
      if (later > kSameTime * h_ || (later >= -kSameTime * h_ && m.speed_m_s <= best.speed_m_s)) continue;
    }
    next = static_cast<int>(i);
  }
  return next;
}

void Collisions::resolve(ContactRows& rows, double h, const std::vector<std::size_t>& first_rate, const Velocities& drift,
                         Velocities& velocity, Velocities& position_offset) {
  drift_ = &drift;
  rows_ = &rows;
  first_rate_ = &first_rate;
  velocity_ = &velocity;
  position_offset_ = &position_offset;
  h_ = h;
  approach_.resize(rows.groups.size());
  for (std::size_t i = 0; i < rows.groups.size(); ++i) approach_[i] = approach(rows.groups[i]);
  const std::size_t max_impacts = kMaxImpacts * rows.groups.size();
  for (std::size_t n = 0; n < max_impacts; ++n) {
    const int next = next_impact();
    if (next < 0) break;
    ContactGroup& struck = rows.groups[static_cast<std::size_t>(next)];
    apply_collision(struck);
    const auto shares = [&](int mover) {
      return mover >= 0 && (mover == struck.mover_a || mover == struck.mover_b);
    };
    for (std::size_t i = 0; i < rows.groups.size(); ++i)
      if (shares(rows.groups[i].mover_a) || shares(rows.groups[i].mover_b))
        approach_[i] = approach(rows.groups[i]);
  }
  for (ContactGroup& g : rows.groups)
    if (g.impacts == 0 && !g.stopped_by_spring) predict_impact(g);
}

}  // namespace tactus::sim::impulse
