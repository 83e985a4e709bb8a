// Undoes a step, and separates bodies that overlap after it.
#include <algorithm>
#include <cmath>

#include "sim_node/behaviour/impulse/world.h"

namespace tactus::sim::impulse {
namespace {

// Maximum sweeps over all contacts, and the change at which they end, m: a hundredth of the overlap that may
// remain.
constexpr int kMaxSeparationSweeps = 200;
constexpr double kSettled_m = 1e-7;
// Change of speed at which overlapping surfaces have stopped, m/s.
constexpr double kStopped_m_s = 1e-9;
// The same for corrections within a step: a thousandth of the overlap that may remain.
constexpr int kMaxCorrectionSweeps = 40;
constexpr double kCorrected_m = 1e-8;

Eigen::Matrix3d world_inertia(const FreeBody& b) {
  const Eigen::Matrix3d turn = b.orientation.toRotationMatrix();
  return turn * b.inertia_kg_m2 * turn.transpose();
}

double spin_energy_J(const FreeBody& b) {
  const Eigen::Vector3d spin = b.orientation.conjugate() * b.spin_rad_s;
  return spin.dot(b.inertia_kg_m2 * spin) / 2;
}

double kinetic_energy_J(const FreeBody& b) { return b.mass_kg * b.velocity_m_s.squaredNorm() / 2 + spin_energy_J(b); }

}  // namespace

void World::save(SavedStep& out) {
  activate_all();
  out.free.clear();
  out.motions.clear();
  out.states.resize(systems_.size());
  out.memories.resize(systems_.size(), JointImpulses(0));
  for (std::size_t s = out.saved_loads.size(); s < systems_.size(); ++s)
    out.saved_loads.push_back(systems_[s].system.saved_loads());
  for (const int unit : active_) {
    if (index(unit) < free_.size()) {
      out.free.push_back(free_[index(unit)]);
      continue;
    }
    const std::size_t s = index(unit) - free_.size();
    out.states[s] = systems_[s].system.state();
    systems_[s].system.copy_loads(out.saved_loads[s]);
    out.memories[s] = systems_[s].memory;
  }
  for (const int body : active_bodies_) out.motions.push_back(motions_[index(body)]);
  out.warm = warm_;
}

void World::restore(const SavedStep& saved) {
  auto free = saved.free.begin();
  for (const int unit : active_) {
    if (index(unit) < free_.size()) {
      free_[index(unit)] = *free++;
      continue;
    }
    const std::size_t s = index(unit) - free_.size();
    systems_[s].system.set_state(saved.states[s]);
    systems_[s].system.set_loads(saved.saved_loads[s]);
    systems_[s].memory = saved.memories[s];
  }
  for (std::size_t i = 0; i < active_bodies_.size(); ++i) motions_[index(active_bodies_[i])] = saved.motions[i];
  warm_ = saved.warm;
}

void World::restore_loads(const SavedStep& saved) {
  auto free = saved.free.begin();
  for (const int unit : active_) {
    if (index(unit) < free_.size()) {
      free_[index(unit)].force_N = free->force_N;
      free_[index(unit)].moment_N_m = free->moment_N_m;
      ++free;
    } else {
      const std::size_t s = index(unit) - free_.size();
      systems_[s].system.set_loads(saved.saved_loads[s]);
    }
  }
}

void World::hold(int unit, const SavedStep& saved, double step_s) {
  std::size_t nth = 0;
  for (const int other : active_) {
    if (other == unit) break;
    if (index(other) < free_.size()) ++nth;
  }
  if (index(unit) < free_.size()) {
    FreeBody& b = free_[index(unit)];
    const Eigen::Matrix3d turn = b.orientation.toRotationMatrix();
    const Eigen::Vector3d spin_momentum = turn * (b.inertia_kg_m2 * (turn.transpose() * b.spin_rad_s));
    const Eigen::Vector3d velocity = b.velocity_m_s - step_s * b.gravity_m_s2;
    b = saved.free[nth];
    b.velocity_m_s = velocity;
    b.step_s = step_s;
    const Eigen::Matrix3d back = b.orientation.toRotationMatrix();
    b.spin_rad_s = back * (b.inertia_kg_m2.inverse() * (back.transpose() * spin_momentum));
    b.force_N = b.moment_N_m = Eigen::Vector3d::Zero();
    motions_[index(body_of_[index(unit)])] = motion_of(b);
    return;
  }
  System& s = systems_[index(unit) - free_.size()];
  articulated::ArticulatedSystem::State state = saved.states[index(unit) - free_.size()];
  state.rates = s.system.state().rates;
  s.system.set_state(state);
  refresh(s);
}

// Scales the impulses of the rows, so that they take at most this energy. u: speed of a point after them, before - that
// without them. With impulses J scaled by s the energy changes by s J before + s^2 J (u - before) / 2, and J u is about 0.
void World::limit_stopping(double max_energy_J) {
  double taken = 0;
  const auto speed = [&](const ContactPoint& p) { return rows_.velocity(p, velocity_).x(); };
  scratch_.clear();
  for (const ContactPoint& p : rows_.points) scratch_.push_back(speed(p));
  for (const ContactPoint& p : rows_.points)
    if (p.impulse.x() > 0) rows_.apply(p, {-p.impulse.x(), 0, 0}, velocity_);
  for (std::size_t i = 0; i < rows_.points.size(); ++i)
    taken -= rows_.points[i].impulse.x() * (speed(rows_.points[i]) + scratch_[i]) / 2;
  const double share = taken <= max_energy_J ? 1 : 1 - std::sqrt(std::max(0.0, 1 - max_energy_J / taken));
  for (ContactPoint& p : rows_.points) {
    p.impulse.x() *= share;
    if (p.impulse.x() > 0) rows_.apply(p, p.impulse, velocity_);
  }
}

void World::stop_approach(std::span<const Manifold> contacts, double min_overlap_m, double max_energy_J) {
  overlapping_.clear();
  for (const Manifold& m : contacts) {
    Manifold& kept = overlapping_.emplace_back(m);
    kept.count = 0;
    for (const ManifoldPoint& p : m.used())
      if (p.depth_m > min_overlap_m) kept.points[index(kept.count++)] = p;
    if (kept.count == 0) overlapping_.pop_back();
  }
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      velocity_.twists[i + 1] = {free_[i].velocity_m_s, free_[i].spin_rad_s};
      drift_.twists[i + 1] = {};
    } else {
      const std::size_t s = i - free_.size();
      const auto& rates = systems_[s].system.state().rates;
      std::copy(rates.begin(), rates.end(), velocity_.rates.begin() + static_cast<std::ptrdiff_t>(first_rate_[s]));
      std::fill_n(drift_.rates.begin() + static_cast<std::ptrdiff_t>(first_rate_[s]), rates.size(), 0.0);
    }
  }
  update_inertia(overlapping_);
  build_rows(overlapping_, 1);
  for (int sweep = 0; sweep < kMaxSeparationSweeps; ++sweep) {
    double change = 0;
    for (ContactPoint& p : rows_.points) {
      const double push = std::max(-p.impulse.x(), -rows_.velocity(p, velocity_).x() / p.mobility(0, 0));
      if (push == 0) continue;
      p.impulse.x() += push;
      rows_.apply(p, {push, 0, 0}, velocity_);
      change = std::max(change, std::abs(push) * p.mobility(0, 0));
    }
    if (change < kStopped_m_s) break;
  }
  limit_stopping(max_energy_J);
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      const Twist& v = velocity_.twists[i + 1];
      if (v.linear_m_s == free_[i].velocity_m_s && v.angular_rad_s == free_[i].spin_rad_s) continue;
      free_[i].velocity_m_s = v.linear_m_s;
      free_[i].spin_rad_s = v.angular_rad_s;
      motions_[index(body_of_[i])] = motion_of(free_[i]);
    } else {
      const std::size_t s = i - free_.size(), first = first_rate_[s];
      scratch_.assign(velocity_.rates.begin() + static_cast<std::ptrdiff_t>(first), velocity_.rates.begin() + static_cast<std::ptrdiff_t>(first_rate_[s + 1]));
      bool changed = false;
      for (std::size_t j = 0; j < scratch_.size(); ++j) {
        scratch_[j] -= systems_[s].system.state().rates[j];
        changed |= scratch_[j] != 0;
      }
      if (!changed) continue;
      systems_[s].system.add_rates(scratch_);
      refresh(systems_[s]);
    }
  }
}

// Adds the smallest displacements, weighted by inertia, with which gaps stay open at the end of the step and overlaps
// shrink by their correction. Velocities change only where floating bodies would lose angular momentum.
void World::correct_positions(double h) {
  end_gap_m_.resize(rows_.points.size());
  lift_.assign(rows_.points.size(), 0);
  for (std::size_t i = 0; i < rows_.points.size(); ++i) {
    const ContactPoint& p = rows_.points[i];
    const double bend = p.couplings == 0 ? followed_bend_m(p, h) : 0;
    end_gap_m_[i] = p.gap_m + h * rows_.velocity(p, velocity_).x() + bend - (p.correction_m > 0 ? p.gap_m + p.correction_m : std::min(0.0, p.gap_m));
  }
  for (int sweep = 0; sweep < kMaxCorrectionSweeps; ++sweep) {
    double change = 0;
    for (std::size_t i = 0; i < rows_.points.size(); ++i) {
      const ContactPoint& p = rows_.points[i];
      if (p.couplings > 0) continue;
      const double lacks = -end_gap_m_[i] - rows_.velocity(p, position_offset_).x();
      const double push = std::max(-lift_[i], lacks / p.mobility(0, 0));
      if (push == 0) continue;
      lift_[i] += push;
      rows_.apply(p, {push, 0, 0}, position_offset_);
      change = std::max(change, std::abs(push) * p.mobility(0, 0));
    }
    if (change < kCorrected_m) break;
  }
  floating_.find(rows_, lift_);
  if (floating_.members().empty()) return;
  lost_kg_m2_s_.resize(velocity_.twists.size());
  for (const auto& m : floating_.members()) lost_kg_m2_s_[index(m.twist)].setZero();
  for (std::size_t i = 0; i < rows_.points.size(); ++i) {
    const ContactPoint& p = rows_.points[i];
    if (lift_[i] == 0) continue;
    const Eigen::Vector3d push = lift_[i] * p.axes.row(0);
    if (p.a) lost_kg_m2_s_[index(p.a)] += push.cross(velocity_.twists[index(p.a)].linear_m_s);
    if (p.b) lost_kg_m2_s_[index(p.b)] -= push.cross(velocity_.twists[index(p.b)].linear_m_s);
  }
  floating_.restore_spin([&](int twist) {
    const FreeBody& b = free_[index(twist - 1)];
    Twist& v = velocity_.twists[index(twist)];
    return FloatingIslands::Body{b.mass_kg, free_motions_[index(twist - 1)].inertia, b.centre_m + position_offset_.twists[index(twist)].linear_m_s,
                                 lost_kg_m2_s_[index(twist)], &v.linear_m_s, &v.angular_rad_s};
  });
}

// Updates the inertia of the bodies in contact, at the current poses.
void World::update_inertia(std::span<const Manifold> contacts) {
  for (const Manifold& m : contacts)
    for (const int body : {m.body_a, m.body_b}) {
      const Mover& at = mover(body);
      if (at.kind != Kind::kFree) continue;
      const BodyMotion& b = motions_[index(body)];
      rows_.inertias[index(at.index + 1)] = {b.inverse_mass_1_kg, b.inverse_inertia};
    }
}

double World::separate(std::span<const Manifold> contacts, double max_overlap_m) {
  activate_all();
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      velocity_.twists[i + 1] = drift_.twists[i + 1] = {};
    } else {
      const std::size_t s = i - free_.size();
      for (std::size_t j = first_rate_[s]; j < first_rate_[s + 1]; ++j) velocity_.rates[j] = drift_.rates[j] = 0;
    }
  }
  update_inertia(contacts);
  build_rows(contacts, 1);
  // Velocities over one second: the smallest change, weighted by inertia, that leaves no overlap.
  for (int sweep = 0; sweep < kMaxSeparationSweeps; ++sweep) {
    double change = 0;
    for (ContactPoint& p : rows_.points) {
      if (p.gap_m < -max_overlap_m) continue;
      const double left = p.gap_m + rows_.velocity(p, velocity_).x();
      const double push = std::max(-p.impulse.x(), -left / p.mobility(0, 0));
      if (push == 0) continue;
      p.impulse.x() += push;
      rows_.apply(p, {push, 0, 0}, velocity_);
      change = std::max(change, std::abs(push) * p.mobility(0, 0));
    }
    if (change < kSettled_m) break;
  }
  lift_.clear();
  for (const ContactPoint& p : rows_.points) lift_.push_back(p.impulse.x());
  floating_.find(rows_, lift_);
  lost_kg_m2_s_.resize(velocity_.twists.size());
  double gained = 0;
  for (const int unit : active_)
    if (index(unit) < free_.size())
      gained += displace_free(unit);
    else
      separate_links(index(unit) - free_.size());
  return gained + restore_spin();
}

// Moves a free body by the result. Returns the energy that it gains, and stores the angular momentum that it loses.
double World::displace_free(int unit) {
  FreeBody& b = free_[index(unit)];
  const Twist& by = velocity_.twists[index(unit + 1)];
  lost_kg_m2_s_[index(unit + 1)].setZero();
  if (by.linear_m_s.isZero(0) && by.angular_rad_s.isZero(0)) return 0;
  const double before_J = spin_energy_J(b);
  const Eigen::Vector3d before = world_inertia(b) * b.spin_rad_s;
  displace(b, by.linear_m_s, by.angular_rad_s);
  place(motions_[index(body_of_[index(unit)])], motion_of(b));
  lost_kg_m2_s_[index(unit + 1)] = before - world_inertia(b) * b.spin_rad_s - b.mass_kg * by.linear_m_s.cross(b.velocity_m_s);
  return spin_energy_J(b) - before_J - b.mass_kg * b.gravity_m_s2.dot(by.linear_m_s);
}

// Returns the energy that the floating bodies gain.
double World::restore_spin() {
  double gained = 0;
  for (const auto& m : floating_.members()) gained -= kinetic_energy_J(free_[index(m.twist - 1)]);
  floating_.restore_spin([&](int twist) {
    FreeBody& b = free_[index(twist - 1)];
    return FloatingIslands::Body{b.mass_kg, world_inertia(b), b.centre_m, lost_kg_m2_s_[index(twist)], &b.velocity_m_s, &b.spin_rad_s};
  });
  for (const auto& m : floating_.members()) {
    gained += kinetic_energy_J(free_[index(m.twist - 1)]);
    motions_[index(body_of_[index(m.twist - 1)])] = motion_of(free_[index(m.twist - 1)]);
  }
  return gained;
}

// Moves an articulated system by the result.
void World::separate_links(std::size_t s) {
  const std::span<const double> by(velocity_.rates.data() + first_rate_[s], first_rate_[s + 1] - first_rate_[s]);
  if (std::all_of(by.begin(), by.end(), [](double x) { return x == 0; })) return;
  systems_[s].system.displace(by);
  systems_[s].system.dynamics();
  for (std::size_t i = 0; i < systems_[s].bodies.size(); ++i)
    place(motions_[index(systems_[s].bodies[i])], systems_[s].system.motion(static_cast<int>(i)));
}

// Sets the pose; the velocities are unchanged.
void World::place(BodyMotion& m, const BodyMotion& at) {
  m.position_m = at.position_m;
  m.centre_m = at.centre_m;
  m.orientation = at.orientation;
  m.inverse_inertia = at.inverse_inertia;
}

void World::centre_velocities(double h_s) {
  for (const int unit : active_)
    if (index(unit) < free_.size()) motions_[index(body_of_[index(unit)])].velocity_m_s = velocity_for(free_[index(unit)], h_s);
}

}  // namespace tactus::sim::impulse
