#include "sim_node/behaviour/impulse/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sync/time/phases.h"

namespace tactus::sim::impulse {

int World::add_fixed() {
  movers_.push_back({});
  motions_.emplace_back();
  return static_cast<int>(movers_.size()) - 1;
}

int World::add_free(const FreeBody& body) {
  movers_.push_back({Kind::kFree, static_cast<int>(free_.size()), 0});
  free_.push_back(body);
  force_time_s_.push_back(0);
  body_of_.push_back(static_cast<int>(movers_.size()) - 1);
  motions_.push_back(motion_of(body));
  return static_cast<int>(movers_.size()) - 1;
}

void World::make_system(const std::vector<int>& bodies, articulated::ArticulatedSystem system) {
  const std::size_t dofs = system.tree().dofs.size();
  system.dynamics();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    movers_[index(bodies[i])] = {Kind::kLink, static_cast<int>(systems_.size()), static_cast<int>(i)};
    motions_[index(bodies[i])] = system.motion(static_cast<int>(i));
  }
  first_rate_.push_back(first_rate_.back() + dofs);
  const bool has_rows = needs_rows(system);
  systems_.push_back({std::move(system), JointImpulses(dofs), bodies, has_rows, false});
}

int World::add_surface(const Surface& surface) {
  surfaces_.push_back(surface);
  return static_cast<int>(surfaces_.size()) - 1;
}

void World::add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kLink) systems_[index(m.index)].system.add_force(m.link, force_N, point_m);
  if (m.kind != Kind::kFree) return;
  FreeBody& b = free_[index(m.index)];
  b.force_N += force_N;
  b.moment_N_m += (point_m - b.centre_m).cross(force_N);
}

void World::add_torque(int body, const Eigen::Vector3d& torque_N_m) {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kLink) systems_[index(m.index)].system.add_moment(m.link, torque_N_m);
  if (m.kind == Kind::kFree) free_[index(m.index)].moment_N_m += torque_N_m;
}

int World::mover_number(const Mover& m) const {
  if (m.kind == Kind::kFixed) return -1;
  return m.kind == Kind::kFree ? m.index + 1 : static_cast<int>(free_.size()) + 1 + m.index;
}

void World::start_velocities(std::span<const Manifold> contacts, double h) {
  activate_all();
  free_motions_.resize(free_.size());
  for (Velocities* v : {&velocity_, &drift_, &position_offset_}) {
    v->twists.resize(free_.size() + 1);
    v->rates.resize(first_rate_.back());
  }
  rows_.inertias.resize(free_.size() + 1);
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      FreeBody& b = free_[i];
      b.velocity_m_s = velocity_for(b, h);
      force_time_s_[i] = b.step_s < 0 ? h : (b.step_s + h) / 2;
      b.step_s = h;
      const FreeMotion& f = free_motions_[i] = free_motion(b, h);
      velocity_.twists[i + 1] = {f.start_m_s, f.start_rad_s};
      drift_.twists[i + 1] = {f.mean_m_s - f.start_m_s, f.mean_rad_s - f.start_rad_s};
      position_offset_.twists[i + 1] = {};
      collisions_.begin_step(i + 1);
      rows_.inertias[i + 1] = {1 / b.mass_kg, f.inverse_inertia};
    } else {
      System& s = systems_[i - free_.size()];
      s.touched = s.has_rows;
    }
  }
  for (const Manifold& m : contacts)
    for (const int body : {m.body_a, m.body_b})
      if (mover(body).kind == Kind::kLink) systems_[index(mover(body).index)].touched = true;
  for (const int unit : active_) {
    if (index(unit) < free_.size()) continue;
    const std::size_t s = index(unit) - free_.size();
    for (std::size_t j = first_rate_[s]; j < first_rate_[s + 1]; ++j)
      velocity_.rates[j] = drift_.rates[j] = position_offset_.rates[j] = 0;
    if (!systems_[s].touched) continue;
    const auto acceleration = systems_[s].system.accelerations();
    const auto& rates = systems_[s].system.state().rates;
    for (std::size_t j = 0; j < rates.size(); ++j) {
      velocity_.rates[first_rate_[s] + j] = rates[j];
      drift_.rates[first_rate_[s] + j] = h / 2 * acceleration[j];
    }
  }
}

// Appends the coupling rows of a point to a system. link_a, link_b: links of the system on the two sides; -1: none.
void World::couple(ContactPoint& p, int system, int link_a, int link_b, const Eigen::Vector3d& point_m) {
  articulated::ArticulatedSystem& s = systems_[index(system)].system;
  const std::size_t n = s.tree().dofs.size();
  if (n == 0) return;
  Coupling c{first_rate_[index(system)], n, rows_.pool.size(), rows_.pool.size() + 3 * n};
  rows_.pool.resize(rows_.pool.size() + 6 * n, 0.0);
  scratch_.resize(3 * n);
  double* jacobian = rows_.pool.data() + c.jacobian;
  double* response = rows_.pool.data() + c.response;
  for (const auto& [link, sign] : {std::pair{link_a, -1.0}, std::pair{link_b, 1.0}}) {
    if (link < 0) continue;
    s.dynamics().jacobian(link, point_m, scratch_);
    for (int r = 0; r < 3; ++r)
      for (std::size_t i = 0; i < n; ++i)
        for (int k = 0; k < 3; ++k) jacobian[index(r) * n + i] += sign * p.axes(r, k) * scratch_[index(k) * n + i];
    for (int r = 0; r < 3; ++r) {
      s.dynamics().impulse_to_rates(link, point_m, p.axes.row(r), std::span(scratch_).first(n));
      for (std::size_t i = 0; i < n; ++i) response[index(r) * n + i] += sign * scratch_[i];
    }
  }
  rows_.couplings.push_back(c);
  ++p.couplings;
}

void World::build_rows(std::span<const Manifold> contacts, double h) {
  rows_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Manifold& m = contacts[i];
    const Mover &a = mover(m.body_a), &b = mover(m.body_b);
    if (m.count == 0 || (a.kind == Kind::kFixed && b.kind == Kind::kFixed)) continue;
    const Surface &sa = surfaces_[index(m.shape_a)], &sb = surfaces_[index(m.shape_b)];
    ContactGroup g{
        static_cast<int>(rows_.points.size()),   m.count, static_cast<int>(i), mover_number(a), mover_number(b),
        std::min(sa.restitution, sb.restitution)};
    if (a.kind == Kind::kFree) g.round_a = sa.round.turned(free_[index(a.index)].orientation);
    if (b.kind == Kind::kFree) g.round_b = sb.round.turned(free_[index(b.index)].orientation);
    for (const ManifoldPoint& at : m.used()) {
      ContactPoint p;
      p.axes.row(0) = at.normal;
      p.axes.row(1) = at.normal.unitOrthogonal();
      p.axes.row(2) = at.normal.cross(Eigen::Vector3d(p.axes.row(1)));
      p.friction = std::sqrt(sa.friction * sb.friction) * at.friction;
      p.mover_a = g.mover_a + 1, p.mover_b = g.mover_b + 1;
      p.gap_m = -at.depth_m - law_.shell_m;
      p.first_coupling = static_cast<int>(rows_.couplings.size());
      if (a.kind == Kind::kFree) {
        p.a = a.index + 1;
        p.arm_a = at.point_m - free_[index(a.index)].centre_m;
        p.force_time_s = force_time_s_[index(a.index)];
      }
      if (b.kind == Kind::kFree) {
        p.b = b.index + 1;
        p.arm_b = at.point_m - free_[index(b.index)].centre_m;
        p.force_time_s = std::max(p.force_time_s, force_time_s_[index(b.index)]);
      } else {
        p.arm_b.setZero();
      }
      if (a.kind == Kind::kLink || b.kind == Kind::kLink) p.force_time_s = h;
      const bool one = a.kind == Kind::kLink && b.kind == Kind::kLink && a.index == b.index;
      if (one) couple(p, a.index, a.link, b.link, at.point_m);
      if (a.kind == Kind::kLink && !one) couple(p, a.index, a.link, -1, at.point_m);
      if (b.kind == Kind::kLink && !one) couple(p, b.index, -1, b.link, at.point_m);
      rows_.compute_mobility(p);
      p.drift_m_s = rows_.velocity(p, drift_);
      rows_.points.push_back(p);
    }
    rows_.groups.push_back(g);
  }
}

void World::build_joints(double h) {
  joints_.clear();
  for (std::size_t s = 0; s < systems_.size(); ++s)
    if (systems_[s].has_rows && present_[index(systems_[s].bodies[0])]) {
      const std::size_t first = joints_.size();
      append_rows(systems_[s].system, first_rate_[s], h, systems_[s].memory, joints_, rows_.pool);
      append_ball_friction(systems_[s].system, first_rate_[s], h, systems_[s].memory, joints_, rows_.pool);
      for (std::size_t j = first; j < joints_.size(); ++j)
        joints_[j].mover = static_cast<int>(free_.size() + 1 + s);
    }
}

void World::finish(double h) {
  const sync::ScopedPhaseTimer phase(sync::Phase::kIntegrate);
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      FreeBody& b = free_[i];
      const Twist &v = velocity_.twists[i + 1], &x = position_offset_.twists[i + 1];
      const Blow& blow = collisions_.blow_of(i + 1);
      // A struck body turns at its new velocity from its impact on. The contact solver counted on the whole step.
      Eigen::Vector3d beyond = x.angular_rad_s;
      if (blow.time_s >= 0)
        beyond += blow.time_s * (v.angular_rad_s - before_contacts_.twists[i + 1].angular_rad_s) - collisions_.offset_rad(i + 1);
      complete_step(b, free_motions_[i], v.linear_m_s, v.angular_rad_s, x.linear_m_s, beyond, blow, h);
      motions_[index(body_of_[i])] = motion_of(b);
    } else {
      finish(i - free_.size(), h);
    }
  }
}

void World::finish(std::size_t s, double h) {
  System& system = systems_[s];
  const std::size_t first = first_rate_[s], n = first_rate_[s + 1] - first;
  if (system.touched) {
    scratch_.resize(n);
    bool changed = false;
    for (std::size_t j = 0; j < n; ++j) {
      scratch_[j] = velocity_.rates[first + j] - drift_.rates[first + j] - system.system.state().rates[j];
      changed |= scratch_[j] != 0;
    }
    if (changed) system.system.add_rates(scratch_);
  }
  if (system.has_rows && limit_corrections(system.system, h, law_.correction_share, law_.max_correction_speed_m_s, scratch_))
    system.system.displace(scratch_);
  system.system.step(h);
  for (std::size_t i = 0; i < system.system.tree().links.size(); ++i) {
    BodyMotion& m = motions_[index(system.bodies[i])];
    const BodyMotion before = m;
    m = system.system.motion(static_cast<int>(i));
    m.velocity_m_s = (m.centre_m - before.centre_m) / h;
    const Eigen::AngleAxisd turned(m.orientation * before.orientation.conjugate());
    m.spin_rad_s = turned.angle() / h * turned.axis();
  }
}

// Half of the effect of constant loads over the step is in the mean velocities.
void World::add_drift() {
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      velocity_.twists[i + 1].linear_m_s += drift_.twists[i + 1].linear_m_s;
      velocity_.twists[i + 1].angular_rad_s += drift_.twists[i + 1].angular_rad_s;
      continue;
    }
    const std::size_t s = i - free_.size();
    for (std::size_t j = first_rate_[s]; j < first_rate_[s + 1]; ++j) velocity_.rates[j] += drift_.rates[j];
  }
}

// Writes the forces and impacts of the step to the contacts.
void World::write_results(std::span<Manifold> contacts, double h) const {
  for (const ContactGroup& g : rows_.groups) {
    Manifold& m = contacts[index(g.manifold)];
    for (int i = 0; i < g.count; ++i) {
      const ContactPoint& p = rows_.points[index(g.first + i)];
      m.points[index(i)].normal_force_N = p.impact_N_s / h + p.impulse.x() / p.force_time_s;
    }
    m.impact = {};
    if (g.first_impact_point < 0) continue;
    // Where the point that would meet first takes no impulse, the impact is at the fastest of those that do.
    int struck = g.first_impact_point;
    double speed = g.speed_m_s;
    if (m.points[index(struck)].normal_force_N <= 0) {
      struck = -1;
      for (int i = 0; i < g.count; ++i) {
        const double closing = -rows_.velocity(rows_.points[index(g.first + i)], before_contacts_).x();
        if (m.points[index(i)].normal_force_N <= 0 || (struck >= 0 && closing <= speed)) continue;
        struck = i;
        speed = closing;
      }
      if (struck < 0) continue;
    }
    const ManifoldPoint& at = m.points[index(struck)];
    const Eigen::Vector3d half = at.depth_m / 2 * at.normal, on_a = at.point_m + half, on_b = at.point_m - half;
    const BodyMotion &a = motions_[index(m.body_a)], &b = motions_[index(m.body_b)];
    m.impact.count = std::max(1, g.impacts);
    m.impact.first_s = std::min(g.first_s, h);
    m.impact.last_s = std::min(g.last_s, h);
    m.impact.speed_m_s = speed;
    m.impact.effective_mass_kg = 1 / rows_.points[index(g.first + struck)].mobility(0, 0);
    const Eigen::Vector3d met_a = on_a + g.first_s * a.velocity_at(on_a),
                          met_b = on_b + g.first_s * b.velocity_at(on_b);
    m.impact.position_m = (met_a + met_b) / 2;
    // Along the normal, the position on the static body is exact.
    if (!a.moves() || !b.moves())
      m.impact.position_m += at.normal.dot((a.moves() ? met_b : met_a) - m.impact.position_m) * at.normal;
    m.impact.normal = at.normal;
    m.impact.a_body_m = a.to_body(on_a), m.impact.b_body_m = b.to_body(on_b);
    m.impact.triangle_a = at.triangle_a, m.impact.triangle_b = at.triangle_b;
  }
}

void World::step(std::span<Manifold> contacts, double h) {
  const sync::ScopedPhaseTimer phase(sync::Phase::kSolve);
  start_velocities(contacts, h);
  build_rows(contacts, h);
  build_joints(h);
  warm_.recall(contacts, motions_, rows_);
  const bool has_penalty = law_.penalty.stiffness_N_m > 0;
  if (!has_penalty) limit_warm_start();
  if (has_penalty) set_penalty_shells(rows_, law_.penalty, velocity_, h);
  collisions_.resolve(rows_, h, first_rate_, drift_, velocity_, position_offset_);
  shift_arms();
  add_drift();
  set_required_speeds(h);
  if (has_penalty) set_penalty_forces(rows_, law_.penalty, velocity_, h);
  layers_.find(rows_, static_cast<int>(free_.size() + systems_.size()) + 1);
  sweep(h);
  if (convergence_.unconverged > 0 && !has_penalty)
    convergence_ = islands_.refine(rows_, joints_, static_cast<int>(free_.size() + systems_.size()) + 1,
                                   law_.convergence_m_s2 * h, before_contacts_, velocity_);
  if (has_corrections_ || convergence_.unconverged > 0) correct_positions(h);
  warm_.store(contacts, motions_, rows_);
  for (const JointRow& row : joints_) *row.memory = row.impulse;
  write_results(contacts, h);
  finish(h);
}

}  // namespace tactus::sim::impulse
