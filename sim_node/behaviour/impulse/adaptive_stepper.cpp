#include "sim_node/behaviour/impulse/adaptive_stepper.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim::impulse {
namespace {

// Sub-division limit: rotation takes no surface further than this from the linear path of the contacts, m. Design
// value: well inside the thinnest walls, from where overlaps are resolved to the original side.
constexpr double kMaxPathDeviation_m = 1e-4;
// An overlap deeper than this may have a wrong normal, m. The step is halved instead.
constexpr double kUnreliableOverlap_m = 3e-4;
// Overlaps deeper than this are resolved by positions, m. Design value: half of the proven limit of 10 um.
constexpr double kResolvedOverlap_m = 5e-6, kMaxOverlap_m = 1e-5;
// Tolerance of the distance that a body may move beyond its speed, m. Design value: gravity over 4 ms; below the
// enlargement of the detectors.
constexpr double kMotionTolerance_m = 1e-4;
// Maximum look-ahead of contacts, m. A feature that is planar from afar may be an edge on arrival. Design value: a
// step of 1 ms at 20 m/s.
constexpr double kMaxLookAhead_m = 0.0201;
constexpr int kMaxSubsteps = 64, kMaxRounds = 8, kMaxSearches = 3;

double max_depth_m(const Manifold& m) {
  double depth = -1;
  for (const ManifoldPoint& p : m.used()) depth = std::max(depth, p.depth_m);
  return depth;
}

double max_depth_m(std::span<const Manifold> contacts) {
  double depth = -1;
  for (const Manifold& m : contacts) depth = std::max(depth, max_depth_m(m));
  return depth;
}

// Calls each(pair, depth) for every pair whose overlap exceeds the limit and has grown.
template <class Each>
void for_each_new_overlap(std::span<const Manifold> now, std::span<const Manifold> before, double limit,
                          Each each) {
  auto old = before.begin();
  for (const Manifold& m : now) {
    const double depth = max_depth_m(m);
    if (depth <= limit) continue;
    while (old != before.end() && old->before(m)) ++old;
    const bool known = old != before.end() && !m.before(*old);
    if (!known || depth > max_depth_m(*old)) each(m, depth);
  }
}

double rotation_angle_rad(const BodyMotion& from, const BodyMotion& to) {
  return 2 * std::asin(std::min(1.0, (to.orientation * from.orientation.conjugate()).vec().norm()));
}

// Deviation from a linear path of a surface point at this lever arm after this rotation.
double path_deviation_m(double lever_m, double angle_rad) {
  return lever_m * (angle_rad < 1 ? angle_rad * angle_rad / 2 : angle_rad);
}

}  // namespace

// Number of substeps into which the step must be divided, from the result of the undivided step.
int AdaptiveStepper::substeps_for(const World& world, std::span<const Manifold> contacts, double dt) const {
  const auto motions = world.motions();
  double max_deviation_m = 0;
  for (const Manifold& m : contacts)
    for (const int body : {m.body_a, m.body_b}) {
      const auto i = static_cast<std::size_t>(body);
      const double spin = std::max(motions[i].spin_rad_s.norm(), assumed_[i].spin_rad_s.norm());
      if (spin > 0 && extents_[i].rotation_lever_m > 0)
        max_deviation_m = std::max(max_deviation_m, path_deviation_m(extents_[i].rotation_lever_m, spin * dt));
    }
  return max_deviation_m <= kMaxPathDeviation_m
             ? 1
             : static_cast<int>(std::ceil(std::sqrt(max_deviation_m / kMaxPathDeviation_m)));
}

// Whether a body moved further than the contacts were searched for. assumed_ then holds its actual motion.
bool AdaptiveStepper::moved_too_far(const World& world, double dt) {
  bool further = false;
  const auto motions = world.motions();
  for (const int body : world.active_bodies()) {
    const auto i = static_cast<std::size_t>(body);
    BodyMotion& before = assumed_[i];
    const Eigen::Vector3d moved = motions[i].centre_m - before.centre_m;
    const double angle = rotation_angle_rad(before, motions[i]), lever = extents_[i].bound_m;
    if (moved.norm() + lever * angle <=
        (before.velocity_m_s.norm() + lever * before.spin_rad_s.norm()) * dt + kMotionTolerance_m)
      continue;
    before.velocity_m_s = moved / dt;
    const Eigen::AngleAxisd turn(motions[i].orientation * before.orientation.conjugate());
    before.spin_rad_s = turn.angle() / dt * turn.axis();
    further = true;
  }
  return further;
}

bool AdaptiveStepper::has_new_pair(std::span<const Manifold> contacts) const {
  auto known = contacts.begin();
  for (const Manifold& m : repeated_search_) {
    while (known != contacts.end() && known->before(m)) ++known;
    if (known == contacts.end() || m.before(*known)) return true;
  }
  return false;
}

bool AdaptiveStepper::try_substep(World& world, ContactSource& source, double& dt, double finest, double next_h,
                                  std::vector<Manifold>& contacts) {
  world.step(contacts, dt);
  const bool divisible = dt > finest * 1.001;
  if (const int substeps = substeps_for(world, contacts, dt); substeps > 1 && divisible) {
    dt = std::max(finest, dt / substeps);
    world.restore(saved_);
    return false;
  }
  if (report_.repeated_searches < kMaxSearches * report_.substeps && moved_too_far(world, dt)) {
    ++report_.repeated_searches;
    source.find(assumed_, world.active_bodies(), dt, repeated_search_);
    if (has_new_pair(contacts)) {
      std::swap(contacts, repeated_search_);
      world.restore(saved_);
      return false;
    }
  }
  source.find(world.motions(), world.active_bodies(), horizon_s(world, next_h), new_contacts_);
  if (divisible && max_new_overlap_m(contacts, kUnreliableOverlap_m) > 0) {
    dt = std::max(finest, dt / 2);
    world.restore(saved_);
    return false;
  }
  return true;
}

// The deepest pair whose overlap exceeds the limit and has grown; 0: none.
double AdaptiveStepper::max_new_overlap_m(std::span<const Manifold> before, double limit) const {
  double deepest = 0;
  for_each_new_overlap(new_contacts_, before, limit,
                       [&](const Manifold&, double depth) { deepest = std::max(deepest, depth); });
  return deepest;
}

// Deep overlaps of the initial scene are left to the solver, which corrects them gently.
void AdaptiveStepper::resolve_overlaps(World& world, ContactSource& source, double next) {
  const auto overlaps = [](const Manifold& m) {
    const double depth = max_depth_m(m);
    return depth > kResolvedOverlap_m && depth <= kUnreliableOverlap_m;
  };
  for (int round = 0; round < kMaxRounds && std::any_of(new_contacts_.begin(), new_contacts_.end(), overlaps);
       ++round) {
    const double gained_J = world.separate(new_contacts_, kUnreliableOverlap_m);
    // The energy that lifts bodies comes from the approach of the surfaces. Otherwise bodies that overlap in many steps,
    // as where a rotating surface sinks below its linear path, would gain energy.
    if (gained_J > 0) world.stop_approach(new_contacts_, 0, gained_J);
    ++report_.separation_rounds;
    source.find(world.motions(), world.active_bodies(), next, new_contacts_);
  }
}

// Last resort: a body whose overlap has grown in the step returns to its start pose, and the impact that its contacts
// did not predict is resolved. Its counterpart has moved away or is held too. In the end all bodies are at poses without
// overlap.
void AdaptiveStepper::reset_overlapping_units(World& world, ContactSource& source, double next, double dt,
                                              std::span<const Manifold> before) {
  reset_units_.clear();
  for (bool changed = max_new_overlap_m(before, kMaxOverlap_m) > 0; changed;) {
    changed = false;
    world.stop_approach(new_contacts_, kMaxOverlap_m);
    for_each_new_overlap(new_contacts_, before, kMaxOverlap_m, [&](const Manifold& m, double) {
      for (const int body : {m.body_a, m.body_b}) {
        const int unit = world.unit_of(body);
        const auto active = world.active_units();
        if (unit < 0 || !std::binary_search(active.begin(), active.end(), unit)) continue;
        if (std::find(reset_units_.begin(), reset_units_.end(), unit) != reset_units_.end()) continue;
        reset_units_.push_back(unit);
        world.hold(unit, saved_, dt);
        changed = true;
      }
    });
    report_.reset_units = static_cast<int>(reset_units_.size());
    if (changed) source.find(world.motions(), world.active_bodies(), next, new_contacts_);
  }
}

// Forces become means over the whole step, times are counted from its start.
void AdaptiveStepper::merge_substep(std::vector<Manifold>& solved, std::span<const Manifold> substep,
                                    double elapsed, double dt, double h) {
  merged_.clear();
  auto old = solved.begin();
  for (const Manifold& m : substep) {
    for (; old != solved.end() && old->before(m); ++old) merged_.push_back(*old);
    Manifold& out = merged_.emplace_back(m);
    for (ManifoldPoint& p : out.used()) p.normal_force_N *= dt / h;
    out.impact.first_s += elapsed, out.impact.last_s += elapsed;
    if (old == solved.end() || m.before(*old)) continue;
    // One pair in two substeps: keeps the points with the larger force and the sum of both forces.
    const auto force = [](const Manifold& x) {
      double sum = 0;
      for (const ManifoldPoint& p : x.used()) sum += p.normal_force_N;
      return sum;
    };
    const double before = force(*old), now = force(out);
    Impact impact = old->impact;
    if (impact.count == 0) {
      impact = out.impact;
    } else if (out.impact.count > 0) {
      // The fastest impact of the step.
      const int count = impact.count + out.impact.count;
      const double last = out.impact.last_s;
      if (out.impact.speed_m_s > impact.speed_m_s) impact = out.impact;
      impact.count = count;
      impact.last_s = last;
    }
    if (before > now) out = *old;
    if (std::max(before, now) > 0)
      for (ManifoldPoint& p : out.used()) p.normal_force_N *= (before + now) / std::max(before, now);
    out.impact = impact;
    ++old;
  }
  merged_.insert(merged_.end(), old, solved.end());
  std::swap(solved, merged_);
}

double AdaptiveStepper::horizon_s(const World& world, double h) const {
  double fastest = 0;
  for (const int body : world.active_bodies()) {
    const BodyMotion& m = world.motions()[static_cast<std::size_t>(body)];
    fastest = std::max(fastest, m.velocity_m_s.norm() + extents_[static_cast<std::size_t>(body)].rotation_lever_m *
                                                            m.spin_rad_s.norm());
  }
  return fastest * h > kMaxLookAhead_m ? std::max(h / kMaxSubsteps, kMaxLookAhead_m / fastest) : h;
}

const RecoveryReport& AdaptiveStepper::step(World& world, ContactSource& source, double h,
                                            std::vector<Manifold>& contacts, std::vector<Manifold>& solved,
                                            double next_h) {
  report_ = {};
  next_h = std::max(h, next_h);
  solved.clear();
  const double finest = h / kMaxSubsteps;
  double elapsed = 0, dt = horizon_s(world, h);
  while (h - elapsed > 1e-9 * h) {
    const double left = h - elapsed;
    // Avoids a very short last substep.
    dt = dt > left * 0.999 ? left : std::min(dt, left);
    world.save(saved_);
    ++report_.substeps;
    assumed_.resize(world.motions().size());
    for (const int body : world.active_bodies())
      assumed_[static_cast<std::size_t>(body)] = world.motions()[static_cast<std::size_t>(body)];
    while (!try_substep(world, source, dt, finest, next_h, contacts)) {
    }
    const IslandSolver::Result& convergence = world.convergence();
    report_.residual_m_s = std::max(report_.residual_m_s, convergence.residual_m_s);
    report_.unconverged = std::max(report_.unconverged, convergence.unconverged);
    report_.limited = std::max(report_.limited, convergence.limited);
    const double next = horizon_s(world, next_h);
    merge_substep(solved, contacts, elapsed, dt, h);
    resolve_overlaps(world, source, next);
    reset_overlapping_units(world, source, next, dt, contacts);
    std::swap(contacts, new_contacts_);
    elapsed += dt;
    dt = std::min({2 * dt, next, h});
    if (h - elapsed > 1e-9 * h) world.restore_loads(saved_);
  }
  if (report_.substeps > 1) world.centre_velocities(h);
  report_.max_overlap_m = max_depth_m(contacts);
  return report_;
}

}  // namespace tactus::sim::impulse
