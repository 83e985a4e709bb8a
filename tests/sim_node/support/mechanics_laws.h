// Laws of mechanics, checked on a world without a driving force, from poses, velocities, contacts and events only: energy,
// overlap, momentum, rest, joints, impacts without an event, and bodies held still by force.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sim_node/behaviour/solver.h"
#include "sim_node/contacts/contact_tracker.h"
#include "sync/bus/identity.h"
#include "tests/sim_node/support/penetration_oracle.h"
#include "tests/sim_node/support/random_worlds.h"

namespace tactus::sim::test {

struct LawReport {
  double over_J = 0;      // largest energy above that of the start
  double rise_J = 0;      // largest rise above an earlier energy
  double scale_J = 0;     // energy in play: kinetic at the start, plus the greatest loss of potential energy
  double allowance_J = 0;  // resolution of the energies
  double overlap_m = 0;
  double momentum = 0, spin_momentum = 0;  // largest change, as a share of those in play
  double creep_m_s = 0, tremble_m_s = 0;   // of the second half
  int held = 0, missed = 0;
  double first_missed_s = -1, first_over_s = -1;
  int unconverged = 0, limited = 0;  // steps, and islands whose impulses were scaled back
  bool finite = true;
  double joint_gap_m = 0;
  std::uint64_t state = 0;  // hash of the poses and velocities at the end
  bool repeats = true;      // the same world gives the same state again; set by the caller
};

enum Law { kFinite, kEnergy, kRise, kOverlap, kMomentumLaw, kRest, kHeld, kEvents, kJoints, kRepeats, kLaws };
inline constexpr std::array<const char*, kLaws> kLawNames{"finite", "over", "rise", "overlap", "momentum", "rest", "held", "events", "joints", "repeats"};

// Hash of poses and velocities, bit-exact.
inline std::uint64_t hash_of(std::span<const BodyMotion> bodies) {
  std::uint64_t hash = sync::kFnv1aBegin;
  const auto add = [&](const auto& values, std::size_t count) { hash = sync::fnv1a_64(hash, values.data(), count * sizeof(double)); };
  for (const BodyMotion& m : bodies) add(m.position_m, 3), add(m.orientation.coeffs(), 4), add(m.velocity_m_s, 3), add(m.spin_rad_s, 3);
  return hash;
}

// Engines other than sim_node's (tests/bench/peers) have the interface of Solver and two constants at most: kStartsEarlier, the
// velocities at the start are those of half a step before; kReportsNoContacts, it has no contacts and no events.
template <class Solver>
class LawCheckerOf {
 public:
  LawCheckerOf(const RandomWorld& w, const Settings& settings)
      : w_(w), settings_(settings), oracle_(w.world), ids_(1), tracker_(surface_traits(w.world, settings), settings, ids_) {}

  LawReport run() {
    Solver solver(w_.world, settings_);
    const double h = settings_.step_s;
    const auto steps = static_cast<int>(std::lround(w_.seconds / h));
    start(solver);
    std::vector<contact_event_t> events;
    tracker_.update({}, sync::from_seconds(h), solver.bodies(), solver.contacts(), solver.solved(), events);
    for (int i = 1; i <= steps && report_.finite; ++i) {
      before_.assign(solver.bodies().begin(), solver.bodies().end());
      solver.step();
      events.clear();
      tracker_.update(sync::SimTime{} + sync::from_seconds(i * h), sync::from_seconds(h), solver.bodies(), solver.contacts(), solver.solved(), events);
      if constexpr (!requires { Solver::kReportsNoContacts; }) note_events(solver, events, i);
      note_energy(solver, i);
      if (i % 7 == 0 && w_.expectation != Expectation::kMomentum) note_overlap(solver);
      if (w_.expectation == Expectation::kMomentum) note_momentum(solver);
      if (!w_.world.joints.empty()) report_.joint_gap_m = std::max(report_.joint_gap_m, largest_joint_gap_m(w_.world, solver.bodies()));
      if (2 * i >= steps) note_rest(solver, 2 * i < steps + 2, (steps - steps / 2) * h);
      if (const auto* r = solver.report()) {
        report_.held += r->reset_units;
        report_.unconverged += r->unconverged > 0;
        report_.limited += r->limited;
      }
    }
    report_.scale_J = scale();
    report_.state = hash_of(solver.bodies());
    return report_;
  }

 private:
  using Vector3d = Eigen::Vector3d;
  double scale() const { return start_kinetic_ + start_potential_ - min_potential_; }
  bool moves(std::size_t i) const { return !w_.world.bodies[i].is_static; }
  Eigen::Matrix3d inertia(std::size_t i, const BodyMotion& m) const {
    const Eigen::Matrix3d r = m.orientation.toRotationMatrix();
    return r * w_.world.bodies[i].inertia_kg_m2 * r.transpose();
  }
  void start(const Solver& solver) {
    report_ = {};
    const double gh = w_.world.gravity_m_s2.norm() * settings_.step_s;
    for (std::size_t i = 0; i < w_.world.bodies.size(); ++i)
      if (moves(i)) report_.allowance_J += 0.5 * w_.world.bodies[i].mass_kg * gh * gh;
    // The oracle does not see an overlap of equal bodies, whose corners are on the surfaces of the other.
    start_overlap_m_ = std::max(oracle_.deepest(solver.bodies()).depth_m, w_.overlap_m);
    // Bodies that touch or overlap at the start are lifted apart, each by at most the sum of the overlaps below it.
    if (w_.touching)
      for (std::size_t i = 0; i < w_.world.bodies.size(); ++i)
        if (moves(i))
          report_.allowance_J += w_.world.bodies[i].mass_kg * w_.world.gravity_m_s2.norm() *
                                 static_cast<double>(w_.world.bodies.size()) * (start_overlap_m_ + 1e-5);
    min_potential_ = 1e300;
    start_J_ = min_J_ = energy(solver, !requires { Solver::kStartsEarlier; });
    start_kinetic_ = start_J_ - min_potential_;
    start_potential_ = min_potential_;
    momentum(solver, linear_, angular_);
    for (std::size_t i = 0; i < w_.world.bodies.size(); ++i) {
      if (!moves(i)) continue;
      const BodyMotion& m = solver.bodies()[i];
      linear_scale_ += w_.world.bodies[i].mass_kg * m.velocity_m_s.norm();
      angular_scale_ += w_.world.bodies[i].mass_kg * m.centre_m.cross(m.velocity_m_s).norm() + (inertia(i, m) * m.spin_rad_s).norm();
    }
    last_event_.assign(w_.world.bodies.size(), -100);
  }
  // Translation is known at the middle of a step, also of a divided one, so half a step of gravity is added.
  double energy(const Solver& solver, bool current) {
    double kinetic = 0, potential = 0;
    const Vector3d& g = w_.world.gravity_m_s2;
    for (std::size_t i = 0; i < w_.world.bodies.size(); ++i) {
      if (!moves(i)) continue;
      const BodyDef& def = w_.world.bodies[i];
      const BodyMotion& m = solver.bodies()[i];
      report_.finite &= m.centre_m.allFinite() && m.velocity_m_s.allFinite() && m.spin_rad_s.allFinite();
      const bool jointed = !w_.world.joints.empty();
      const Vector3d v = current || jointed ? m.velocity_m_s : Vector3d(m.velocity_m_s + settings_.step_s / 2 * g);
      kinetic += 0.5 * def.mass_kg * v.squaredNorm() + 0.5 * m.spin_rad_s.dot(inertia(i, m) * m.spin_rad_s);
      potential -= def.mass_kg * g.dot(m.centre_m);
    }
    min_potential_ = std::min(min_potential_, potential);
    return kinetic + potential;
  }
  void note_energy(const Solver& solver, int step) {
    const double now = energy(solver, false);
    if (now - start_J_ > report_.over_J) report_.over_J = now - start_J_;
    if (report_.first_over_s < 0 && now - min_J_ > 1e-3 * scale() + report_.allowance_J) report_.first_over_s = step * settings_.step_s;
    report_.rise_J = std::max(report_.rise_J, now - min_J_);
    min_J_ = std::min(min_J_, now);
  }
  void note_overlap(const Solver& solver) {
    report_.overlap_m = std::max(report_.overlap_m, oracle_.deepest(solver.bodies()).depth_m - start_overlap_m_);
  }
  void momentum(const Solver& solver, Vector3d& linear, Vector3d& angular) const {
    linear = angular = Vector3d::Zero();
    for (std::size_t i = 0; i < w_.world.bodies.size(); ++i) {
      if (!moves(i)) continue;
      const BodyMotion& m = solver.bodies()[i];
      const Vector3d p = w_.world.bodies[i].mass_kg * m.velocity_m_s;
      linear += p;
      angular += m.centre_m.cross(p) + inertia(i, m) * m.spin_rad_s;
    }
  }
  void note_momentum(const Solver& solver) {
    Vector3d linear, angular;
    momentum(solver, linear, angular);
    report_.momentum = std::max(report_.momentum, (linear - linear_).norm() / linear_scale_);
    report_.spin_momentum = std::max(report_.spin_momentum, (angular - angular_).norm() / angular_scale_);
  }
  void note_rest(const Solver& solver, bool first, double seconds) {
    if (first) half_.assign(solver.bodies().begin(), solver.bodies().end());
    if (half_.empty()) return;
    report_.creep_m_s = 0;
    for (std::size_t i = 0; i < w_.world.bodies.size(); ++i) {
      if (!moves(i)) continue;
      const BodyMotion& m = solver.bodies()[i];
      report_.creep_m_s = std::max(report_.creep_m_s, (m.centre_m - half_[i].centre_m).norm() / seconds);
      report_.tremble_m_s = std::max(report_.tremble_m_s, m.velocity_m_s.norm());
    }
  }
  // A body whose velocity changes by more than kBlow_m_s within a step, beyond gravity, received a blow. One of the bodies that
  // contacts connect with it must have had an event shortly before.
  void note_events(const Solver& solver, const std::vector<contact_event_t>& events, int step) {
    constexpr double kBlow_m_s = 0.2;
    constexpr int kRecent = 7;  // steps: the shortest time between two hits of one contact, and two more
    for (const contact_event_t& e : events)
      if (e.kind != contact_event_t::END) last_event_[static_cast<std::size_t>(e.body_a)] = last_event_[static_cast<std::size_t>(e.body_b)] = step;
    std::vector<int> root(w_.world.bodies.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int i) {
      while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
      return i;
    };
    for (const Manifold& m : solver.solved())
      if (moves(static_cast<std::size_t>(m.body_a)) && moves(static_cast<std::size_t>(m.body_b)))
        root[static_cast<std::size_t>(find(m.body_a))] = find(m.body_b);
    for (std::size_t i = 0; i < root.size(); ++i) {
      if (!moves(i) || !w_.world.joints.empty()) continue;
      const BodyMotion& m = solver.bodies()[i];
      const double half = step == 1 ? 0.5 : 1;
      const Vector3d by = m.velocity_m_s - before_[i].velocity_m_s - half * settings_.step_s * w_.world.gravity_m_s2;
      if (by.norm() < kBlow_m_s) continue;
      bool reported = false;
      for (std::size_t j = 0; j < root.size(); ++j)
        reported |= find(static_cast<int>(j)) == find(static_cast<int>(i)) && step - last_event_[j] <= kRecent;
      if (reported) continue;
      if (report_.missed++ == 0) report_.first_missed_s = step * settings_.step_s;
    }
  }

  const RandomWorld& w_;
  Settings settings_;
  PenetrationOracle oracle_;
  Ids ids_;
  ContactTracker tracker_;
  LawReport report_;
  double start_J_ = 0, min_J_ = 0, start_kinetic_ = 0, start_potential_ = 0, min_potential_ = 0, start_overlap_m_ = 0, linear_scale_ = 1e-12, angular_scale_ = 1e-12;
  Vector3d linear_, angular_;
  std::vector<BodyMotion> before_, half_;
  std::vector<int> last_event_;
};

using LawChecker = LawCheckerOf<Solver>;

// The laws that a world breaks, one flag each.
inline std::array<bool, kLaws> broken_laws(const RandomWorld& w, const LawReport& r) {
  std::array<bool, kLaws> out{};
  out[kFinite] = !r.finite;
  // Joints: velocities are means over a step, so that energies are known to a hundredth only.
  const double share = w.world.joints.empty() ? 1e-4 : 1e-2, allowed = share * r.scale_J + r.allowance_J;
  out[kEnergy] = !(r.over_J <= allowed);
  out[kRise] = !(r.rise_J <= allowed);
  out[kOverlap] = r.overlap_m > 1.05e-5;
  out[kMomentumLaw] = w.expectation == Expectation::kMomentum && (r.momentum > 1e-12 || r.spin_momentum > 1e-6);
  const double slide_m_s = w.world.gravity_m_s2.norm() * w.slope * w.seconds;
  out[kRest] = w.expectation == Expectation::kRests && (r.creep_m_s > 1e-6 + slide_m_s || r.tremble_m_s > 1e-4 + slide_m_s);
  out[kHeld] = r.held > 0;
  out[kEvents] = r.missed > 0;
  out[kJoints] = r.joint_gap_m > 1e-5;  // as small as an overlap
  out[kRepeats] = !r.repeats;
  return out;
}

}  // namespace tactus::sim::test
