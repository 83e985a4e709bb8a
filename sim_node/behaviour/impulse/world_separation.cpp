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
// The same for corrections within a step: a thousandth of the overlap that may remain.
constexpr int kMaxCorrectionSweeps = 40;
constexpr double kCorrected_m = 1e-8;

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

void World::hold(int unit, const SavedStep& saved) {
  std::size_t nth = 0;
  for (const int other : active_) {
    if (other == unit) break;
    if (index(other) < free_.size()) ++nth;
  }
  const auto saved_motion = [&](int body) -> const BodyMotion& {
    const auto at = std::lower_bound(active_bodies_.begin(), active_bodies_.end(), body);
    return saved.motions[static_cast<std::size_t>(at - active_bodies_.begin())];
  };
  const auto rest = [&](int body) {
    BodyMotion& m = motions_[index(body)] = saved_motion(body);
    m.velocity_m_s = m.spin_rad_s = Eigen::Vector3d::Zero();
  };
  if (index(unit) < free_.size()) {
    FreeBody& b = free_[index(unit)];
    b = saved.free[nth];
    b.velocity_m_s = b.spin_rad_s = b.force_N = b.moment_N_m = Eigen::Vector3d::Zero();
    rest(body_of_[index(unit)]);
    return;
  }
  System& s = systems_[index(unit) - free_.size()];
  articulated::ArticulatedSystem::State state = saved.states[index(unit) - free_.size()];
  std::fill(state.rates.begin(), state.rates.end(), 0.0);
  s.system.set_state(state);
  for (const int body : s.bodies) rest(body);
}

// Adds the smallest displacements, weighted by inertia, with which gaps stay open at the end of the step and overlaps
// shrink by their correction. Velocities do not change.
void World::correct_positions(double h) {
  end_gap_m_.resize(rows_.points.size());
  lift_.assign(rows_.points.size(), 0);
  for (std::size_t i = 0; i < rows_.points.size(); ++i) {
    const ContactPoint& p = rows_.points[i];
    end_gap_m_[i] = p.gap_m + h * rows_.velocity(p, velocity_).x() - (p.correction_m > 0 ? p.gap_m + p.correction_m : std::min(0.0, p.gap_m));
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
    if (change < kCorrected_m) return;
  }
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

void World::separate(std::span<const Manifold> contacts, double max_overlap_m) {
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
  for (const int unit : active_) {
    const std::size_t i = index(unit);
    if (i < free_.size()) {
      const Twist& by = velocity_.twists[i + 1];
      if (by.linear_m_s.isZero(0) && by.angular_rad_s.isZero(0)) continue;
      displace(free_[i], by.linear_m_s, by.angular_rad_s);
      place(motions_[index(body_of_[i])], motion_of(free_[i]));
    } else {
      separate(i - free_.size());
    }
  }
}

// Moves an articulated system by the result.
void World::separate(std::size_t s) {
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

}  // namespace tactus::sim::impulse
