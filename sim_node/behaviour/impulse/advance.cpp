#include "sim_node/behaviour/impulse/advance.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim::impulse {
namespace {

// A step is divided so far that turning takes no surface further than this from the straight way that the contacts
// know, m; design: well inside the thinnest walls, from where surfaces are put apart to the side that they came
// from.
constexpr double kBend_m = 1e-4;
// An overlap that deep may have its normal wrong: the step is halved instead, m.
constexpr double kDeep_m = 3e-4;
// An overlap above this is put apart, m: design: half of what may be seen by the proofs, 10 um.
constexpr double kOverlap_m = 5e-6, kMaxOverlap_m = 1e-5;
// By so much a body may come further than its speed said, m; design: gravity over 4 ms; below what detectors add.
constexpr double kFurther_m = 1e-4;
// Contacts are not sought further ahead than this, m: what was planar from afar may be seen edge on when it comes;
// design: a step of 1 ms at 20 m/s.
constexpr double kFarthest_m = 0.0201;
constexpr int kMaxPieces = 64, kMaxRounds = 8, kMaxSearches = 3;

double deepest_of(const Manifold& m) {
  double depth = -1;
  for (const ManifoldPoint& p : m.used()) depth = std::max(depth, p.depth_m);
  return depth;
}

double deepest_of(std::span<const Manifold> contacts) {
  double depth = -1;
  for (const Manifold& m : contacts) depth = std::max(depth, deepest_of(m));
  return depth;
}

// Calls each(pair, how deep it is) for every pair that overlaps by more than the limit, and by more than before.
template <class Each>
void for_each_deeper(std::span<const Manifold> now, std::span<const Manifold> before, double limit, Each each) {
  auto old = before.begin();
  for (const Manifold& m : now) {
    const double depth = deepest_of(m);
    if (depth <= limit) continue;
    while (old != before.end() && old->before(m)) ++old;
    const bool known = old != before.end() && !m.before(*old);
    if (!known || depth > deepest_of(*old)) each(m, depth);
  }
}

double turned_rad(const BodyMotion& from, const BodyMotion& to) {
  return 2 * std::asin(std::min(1.0, (to.orientation * from.orientation.conjugate()).vec().norm()));
}

// How far a surface at that lever leaves the straight line while it turns by an angle.
double bend(double lever_m, double angle_rad) {
  return lever_m * (angle_rad < 1 ? angle_rad * angle_rad / 2 : angle_rad);
}

}  // namespace

// Into how many the step must be divided, from what was just done in one go.
int Advance::pieces_for(const World& world, std::span<const Manifold> contacts, double dt) const {
  const auto motions = world.motions();
  double most = 0;
  for (const Manifold& m : contacts)
    for (const int body : {m.body_a, m.body_b}) {
      const auto i = static_cast<std::size_t>(body);
      const double spin = std::max(motions[i].spin_rad_s.norm(), assumed_[i].spin_rad_s.norm());
      if (spin > 0 && extents_[i].bend_m > 0) most = std::max(most, bend(extents_[i].bend_m, spin * dt));
    }
  return most <= kBend_m ? 1 : static_cast<int>(std::ceil(std::sqrt(most / kBend_m)));
}

// Whether some body moved further than contacts were sought for; assumed_ then has how it really moved.
bool Advance::came_further(const World& world, double dt) {
  bool further = false;
  const auto motions = world.motions();
  for (const int body : world.active_bodies()) {
    const auto i = static_cast<std::size_t>(body);
    BodyMotion& before = assumed_[i];
    const Eigen::Vector3d moved = motions[i].centre_m - before.centre_m;
    const double angle = turned_rad(before, motions[i]), lever = extents_[i].bound_m;
    if (moved.norm() + lever * angle <=
        (before.velocity_m_s.norm() + lever * before.spin_rad_s.norm()) * dt + kFurther_m)
      continue;
    before.velocity_m_s = moved / dt;
    const Eigen::AngleAxisd turn(motions[i].orientation * before.orientation.conjugate());
    before.spin_rad_s = turn.angle() / dt * turn.axis();
    further = true;
  }
  return further;
}

bool Advance::lacks_pair(std::span<const Manifold> contacts) const {
  auto known = contacts.begin();
  for (const Manifold& m : ahead_) {
    while (known != contacts.end() && known->before(m)) ++known;
    if (known == contacts.end() || m.before(*known)) return true;
  }
  return false;
}

bool Advance::attempt(World& world, ContactSource& source, double& dt, double finest, double next_h,
                      std::vector<Manifold>& contacts) {
  world.step(contacts, dt);
  const bool divisible = dt > finest * 1.001;
  if (const int pieces = pieces_for(world, contacts, dt); pieces > 1 && divisible) {
    dt = std::max(finest, dt / pieces);
    world.take_back(kept_);
    return false;
  }
  if (report_.found_again < kMaxSearches * report_.pieces && came_further(world, dt)) {
    ++report_.found_again;
    source.find(assumed_, world.active_bodies(), dt, ahead_);
    if (lacks_pair(contacts)) {
      std::swap(contacts, ahead_);
      world.take_back(kept_);
      return false;
    }
  }
  source.find(world.motions(), world.active_bodies(), horizon_s(world, next_h), after_);
  if (divisible && worst(contacts, kDeep_m) > 0) {
    dt = std::max(finest, dt / 2);
    world.take_back(kept_);
    return false;
  }
  return true;
}

// The deepest of the pairs that overlap by more than the limit, and by more than before; 0: none does.
double Advance::worst(std::span<const Manifold> before, double limit) const {
  double deepest = 0;
  for_each_deeper(after_, before, limit,
                  [&](const Manifold&, double depth) { deepest = std::max(deepest, depth); });
  return deepest;
}

// Overlaps that a scene began with are left to the solver, which takes them back gently.
void Advance::clear_overlaps(World& world, ContactSource& source, double next) {
  const auto overlaps = [](const Manifold& m) {
    const double depth = deepest_of(m);
    return depth > kOverlap_m && depth <= kDeep_m;
  };
  for (int round = 0; round < kMaxRounds && std::any_of(after_.begin(), after_.end(), overlaps); ++round) {
    world.separate(after_, kDeep_m);
    ++report_.separated;
    source.find(world.motions(), world.active_bodies(), next, after_);
  }
}

// The last resort: what is deeper in something than at the start of the step stays there, at rest. What it was in
// has moved there meanwhile, or stays too; in the end all are where nothing overlapped.
void Advance::hold_back(World& world, ContactSource& source, double next, std::span<const Manifold> before) {
  held_.clear();
  for (bool changed = true; changed;) {
    changed = false;
    for_each_deeper(after_, before, kMaxOverlap_m, [&](const Manifold& m, double) {
      for (const int body : {m.body_a, m.body_b}) {
        const int unit = world.unit_of(body);
        const auto active = world.active_units();
        if (unit < 0 || !std::binary_search(active.begin(), active.end(), unit)) continue;
        if (std::find(held_.begin(), held_.end(), unit) != held_.end()) continue;
        held_.push_back(unit);
        world.hold(unit, kept_);
        changed = true;
      }
    });
    report_.held = static_cast<int>(held_.size());
    if (changed) source.find(world.motions(), world.active_bodies(), next, after_);
  }
}

// Forces are means over the whole step, instants are counted from its start.
void Advance::add_to(std::vector<Manifold>& solved, std::span<const Manifold> piece, double begun, double dt,
                     double h) {
  merged_.clear();
  auto old = solved.begin();
  for (const Manifold& m : piece) {
    for (; old != solved.end() && old->before(m); ++old) merged_.push_back(*old);
    Manifold& out = merged_.emplace_back(m);
    for (ManifoldPoint& p : out.used()) p.normal_force_N *= dt / h;
    out.impact.first_s += begun, out.impact.last_s += begun;
    if (old == solved.end() || m.before(*old)) continue;
    // One pair in two pieces: the points of the one that pressed more, with the forces of both.
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
      impact.count += out.impact.count;
      impact.last_s = out.impact.last_s;
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

double Advance::horizon_s(const World& world, double h) const {
  double fastest = 0;
  for (const int body : world.active_bodies()) {
    const BodyMotion& m = world.motions()[static_cast<std::size_t>(body)];
    fastest = std::max(
        fastest, m.velocity_m_s.norm() + extents_[static_cast<std::size_t>(body)].bend_m * m.spin_rad_s.norm());
  }
  return fastest * h > kFarthest_m ? std::max(h / kMaxPieces, kFarthest_m / fastest) : h;
}

const StepReport& Advance::step(World& world, ContactSource& source, double h, std::vector<Manifold>& contacts,
                                std::vector<Manifold>& solved, double next_h) {
  report_ = {};
  next_h = std::max(h, next_h);
  solved.clear();
  const double finest = h / kMaxPieces;
  double begun = 0, dt = horizon_s(world, h);
  while (h - begun > 1e-9 * h) {
    const double left = h - begun;
    // No sliver is left over.
    dt = dt > left * 0.999 ? left : std::min(dt, left);
    world.keep(kept_);
    ++report_.pieces;
    assumed_.resize(world.motions().size());
    for (const int body : world.active_bodies())
      assumed_[static_cast<std::size_t>(body)] = world.motions()[static_cast<std::size_t>(body)];
    while (!attempt(world, source, dt, finest, next_h, contacts)) {
    }
    const double next = horizon_s(world, next_h);
    add_to(solved, contacts, begun, dt, h);
    clear_overlaps(world, source, next);
    hold_back(world, source, next, contacts);
    std::swap(contacts, after_);
    begun += dt;
    dt = std::min({2 * dt, next, h});
    if (h - begun > 1e-9 * h) world.load_again(kept_);
  }
  report_.deepest_m = deepest_of(contacts);
  return report_;
}

}  // namespace tactus::sim::impulse
