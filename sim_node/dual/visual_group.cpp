#include "sim_node/dual/visual_group.h"

#include <algorithm>
#include <tactus/contact_event_t.hpp>

#include "sim_node/dual/group_bodies.h"
#include "sim_node/model/finite_motion.h"
#include "sim_node/model/index.h"

namespace tactus::sim {
namespace {

// Bodies touch within this distance, m; design: the gap at which a contact is reported before it closes.
constexpr double kTouching_m = 0.001;

std::vector<char> may_sleep(const WorldDef& def) {
  std::vector<char> out;
  for (const BodyDef& b : def.bodies) out.push_back(!b.is_static && b.tool < 0);
  for (const JointDef& j : def.joints)
    for (const int body : {j.parent, j.child})
      if (body >= 0) out[index(body)] = 0;
  return out;
}

}  // namespace

VisualGroup::VisualGroup(const WorldDef& def, const Settings& settings, std::vector<double> radii_m, Ids ids,
                         const std::shared_ptr<MeshTrees>& trees)
    : settings_(for_visual_group(settings)),
      radii_m_(std::move(radii_m)),
      frames_(def),
      world_(impulse::build_world(def, settings_)),
      finder_(def, settings_, trees),
      source_(*this),
      stepper_(extents_of(def)),
      scene_(def, *world_),
      ids_(ids),
      tracker_(surface_traits(def, settings_), settings_, ids_),
      entering_tracker_(surface_traits(def, settings_), settings_, ids_),
      sleeping_(may_sleep(def)),
      mask_(def.bodies.size()),
      motions_(frames_.at_start(def)),
      contact_motions_(motions_) {
  for (int i = 0; i < world_->units(); ++i) units_.push_back(i);
  activate();
  read_motions();
}

// Sleeping units belong to the group but are not computed.
void VisualGroup::activate() {
  const auto active = world_->active_units();
  awake_.clear();
  for (const int unit : units_) {
    list_.clear();
    world_->unit_bodies(unit, list_);
    if (!sleeping_.is_asleep(list_.front())) awake_.push_back(unit);
  }
  if (!std::equal(awake_.begin(), awake_.end(), active.begin(), active.end())) found_ = false;
  world_->set_active(awake_);
}

void VisualGroup::read_motions() {
  for (const int body : world_->active_bodies())
    motions_[index(body)] = frames_.motion(body, world_->motions()[index(body)]);
}

// Leaves the bodies of the units in list_.
void VisualGroup::mark(std::span<const int> units, char value) {
  list_.clear();
  for (const int unit : units) world_->unit_bodies(unit, list_);
  for (const int body : list_) mask_[index(body)] = value;
}

// Tracks the contacts of the woken bodies again.
void VisualGroup::wake(std::span<const int> woken) {
  if (woken.empty()) return;
  for (const int body : woken) mask_[index(body)] = 1;
  const auto wakes = [&](const LiveContact& c) {
    return mask_[index(c.manifold.body_a)] || mask_[index(c.manifold.body_b)];
  };
  moved_.clear();
  std::copy_if(sleeping_contacts_.begin(), sleeping_contacts_.end(), std::back_inserter(moved_), wakes);
  std::erase_if(sleeping_contacts_, wakes);
  tracker_.insert(moved_);
  for (const int body : woken) mask_[index(body)] = 0;
}

void VisualGroup::update_sleeping(sync::Nanoseconds length) {
  const auto newly_asleep = sleeping_.update(world_->active_bodies(), motions_, touching_, supported_, length);
  if (newly_asleep.empty()) return;
  for (const int body : newly_asleep) mask_[index(body)] = 1;
  tracker_.extract(mask_, sleeping_contacts_);
  for (const int body : newly_asleep) {
    motions_[index(body)].velocity_m_s.setZero();
    motions_[index(body)].spin_rad_s.setZero();
    mask_[index(body)] = 0;
  }
}

void VisualGroup::remove_leaving(const VisualTask& task) {
  if (task.leaving.empty()) return;
  mark(task.leaving, 0);
  wake(sleeping_.wake_islands_of(list_));
  mark(task.leaving, 1);
  moved_.clear();
  tracker_.extract(mask_, moved_);
  mark(task.leaving, 0);
  std::erase_if(units_,
                [&](int unit) { return std::binary_search(task.leaving.begin(), task.leaving.end(), unit); });
}

// Entering units were in the haptic group at the beginning of the previous step. They catch up by themselves, since
// they reach no other body in it.
void VisualGroup::add_entering(const VisualTask& task, VisualStep& out) {
  const UnitTransfer& entering = task.entering;
  if (entering.units.empty()) return;
  for (std::size_t k = 0; k < entering.units.size(); ++k) world_->set_state(entering.units[k], entering.states[k]);
  world_->set_active(entering.units);
  read_motions();
  entering_tracker_.insert(entering.contacts);
  sub_steps(entering_tracker_, now_ - task.catch_up_time, task.catch_up_time, out, false);
  moved_.clear();
  std::fill(mask_.begin(), mask_.end(), 1);
  entering_tracker_.extract(mask_, moved_);
  std::fill(mask_.begin(), mask_.end(), 0);
  tracker_.insert(moved_);
  units_.insert(units_.end(), entering.units.begin(), entering.units.end());
  std::sort(units_.begin(), units_.end());
}

// Whether an awake body is about to strike a resting one.
bool VisualGroup::is_about_to_strike(const Manifold& m, int awake, double h) const {
  const BodyMotion &a = motions_[index(m.body_a)], &b = motions_[index(m.body_b)];
  return motions_[index(awake)].moves() &&
         std::any_of(m.used().begin(), m.used().end(), [&](const ManifoldPoint& p) {
           const double closing = (a.velocity_at(p.point_m) - b.velocity_at(p.point_m)).dot(p.normal);
           return closing > SleepingIslands::kSleepSpeed_m_s && -p.depth_m <= closing * h;
         });
}

void VisualGroup::Contacts::find(std::span<const BodyMotion> motions, std::span<const int> active, double h,
                                 std::vector<Manifold>& out) {
  VisualGroup& g = group_;
  for (const int body : active) g.contact_motions_[index(body)] = g.frames_.motion(body, motions[index(body)]);
  straight_.clear();
  if (g.sleeping_.count() > 0)
    for (const int body : active) {
      const BodyMotion& m = g.contact_motions_[index(body)];
      straight_.push_back({m.centre_m, m.velocity_m_s, g.radii_m_[index(body)], kTouching_m});
    }
  const auto near = g.sleeping_.near(straight_, g.contact_motions_, g.radii_m_, h);
  if (near.empty()) return g.finder_.find(g.contact_motions_, active, h, out);
  checked_bodies_.assign(active.begin(), active.end());
  checked_bodies_.insert(checked_bodies_.end(), near.begin(), near.end());
  std::sort(checked_bodies_.begin(), checked_bodies_.end());
  g.finder_.find(g.contact_motions_, checked_bodies_, h, out);
  const auto still = [&](int body) {
    return g.sleeping_.is_asleep(body) || !g.contact_motions_[index(body)].moves();
  };
  std::erase_if(out, [&](const Manifold& m) { return still(m.body_a) && still(m.body_b); });
}

// Wakes the resting bodies that are about to be struck, with their islands.
bool VisualGroup::wake_struck(double h) {
  if (sleeping_.count() == 0) return false;
  list_.clear();
  for (const Manifold& m : contacts_) {
    if (sleeping_.is_asleep(m.body_a) && is_about_to_strike(m, m.body_b, h)) list_.push_back(m.body_a);
    if (sleeping_.is_asleep(m.body_b) && is_about_to_strike(m, m.body_a, h)) list_.push_back(m.body_b);
  }
  if (list_.empty()) return false;
  wake(sleeping_.wake_islands_of(list_));
  activate();
  return true;
}

// record: true for the group; false for units that catch up by themselves.
void VisualGroup::sub_steps(ContactTracker& tracker, sync::SimTime begin, sync::Nanoseconds length,
                            VisualStep& out, bool record) {
  const auto at = [&](int k) { return sync::Nanoseconds(length.count() * k / settings_.visual_substeps); };
  const auto find = [&](double h) {
    source_.find(world_->motions(), world_->active_bodies(), stepper_.horizon_s(*world_, h), contacts_);
  };
  double h = sync::to_seconds(at(1));
  // The contacts found at the end of the previous step are reused if no unit has come or gone and the step is not
  // longer.
  if (!record || !found_ || h > found_for_s_) find(h);
  for (int k = 0; k < settings_.visual_substeps; ++k) {
    h = sync::to_seconds(at(k + 1) - at(k));
    while (record && wake_struck(h)) find(h);
    if (record) record_sub_step(index(k), at(k), out);
    // Steps have one of two lengths that differ by a tick: the next one may be as long as the previous one.
    const double next_s = std::max(h, before_s_);
    stepper_.step(*world_, source_, h, contacts_, solved_, next_s);
    frames_.place_impacts(solved_);
    found_ = record;
    found_for_s_ = next_s;
    before_s_ = h;
    // The last contact detection was at the end of the step.
    for (const int body : world_->active_bodies()) {
      motions_[index(body)] = contact_motions_[index(body)];
      require_finite(body, motions_[index(body)]);
    }
    const std::size_t first = out.events.size();
    tracker.update(begin + at(k + 1), at(k + 1) - at(k), motions_, contacts_, solved_, out.events);
    if (record) {
      tracker.take_previous(out.live[index(k)]);
      add_sleeping(out.live[index(k)]);
    }
    for (const LiveContact& c : tracker.live()) record_touching(c.manifold.body_a, c.manifold.body_b);
    for (std::size_t i = first; i < out.events.size(); ++i)
      record_touching(out.events[i].body_a, out.events[i].body_b);
    if (record)
      for (const int body : out.bodies) centres_m_.push_back(motions_[index(body)].centre_m);
  }
}

void VisualGroup::record_touching(int a, int b) {
  supported_[index(a)] = supported_[index(b)] = 1;
  if (motions_[index(a)].moves() && motions_[index(b)].moves())
    touching_.emplace_back(std::min(a, b), std::max(a, b));
}

void VisualGroup::record_sub_step(std::size_t k, sync::Nanoseconds passed, VisualStep& out) {
  out.times.push_back(passed);
  out.states[k].resize(units_.size());
  for (std::size_t i = 0; i < units_.size(); ++i) world_->copy_state(units_[i], out.states[k][i]);
}

void VisualGroup::add_sleeping(std::vector<LiveContact>& live) const {
  live.insert(live.end(), sleeping_contacts_.begin(), sleeping_contacts_.end());
}

// Straight lines from the poses at the beginning to those at the end of the step.
void VisualGroup::record_trajectories(VisualStep& out) {
  const double length_s = sync::to_seconds(out.task.length);
  const std::size_t n = out.bodies.size(), steps = n > 0 ? centres_m_.size() / n : 0;
  straight_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t body = index(out.bodies[i]);
    const Eigen::Vector3d from = out.begin[body].centre_m, by = motions_[body].centre_m - from;
    double deviation_m = 0;
    for (std::size_t k = 0; k + 1 < steps; ++k) {
      const double share = sync::to_seconds(out.times[k + 1]) / length_s;
      deviation_m = std::max(deviation_m, (centres_m_[k * n + i] - from - share * by).norm());
    }
    straight_.push_back({from, by / length_s, radii_m_[body], deviation_m + kTouching_m});
  }
  std::sort(touching_.begin(), touching_.end());
  touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
  out.trajectories.set(motions_.size(), out.bodies, straight_, touching_, length_s);
}

void VisualGroup::run(const VisualTask& task, VisualStep& out) {
  out.task = task;
  out.events.clear();
  out.times.clear();
  touching_.clear();
  centres_m_.clear();
  supported_.assign(motions_.size(), 0);
  remove_leaving(task);
  for (const impulse::SceneChange& change : task.changes) scene_.apply(*world_, change);
  if (!task.changes.empty()) found_ = false;
  if (!task.changes.empty()) wake(sleeping_.wake_all());
  add_entering(task, out);
  activate();
  out.begins = now_;
  out.units = units_;
  out.bodies.clear();
  for (const int unit : units_) world_->unit_bodies(unit, out.bodies);
  std::sort(out.bodies.begin(), out.bodies.end());
  out.begin = motions_;
  out.states.resize(index(settings_.visual_substeps) + 1);
  out.live.resize(index(settings_.visual_substeps) + 1);
  sub_steps(tracker_, now_, task.length, out, true);
  for (const LiveContact& c : sleeping_contacts_) record_touching(c.manifold.body_a, c.manifold.body_b);
  // Events are published in order of time; within a sub-step they are found in order of shapes.
  std::stable_sort(out.events.begin(), out.events.end(),
                   [](const contact_event_t& x, const contact_event_t& y) { return x.time_ns < y.time_ns; });
  now_ += task.length;
  record_sub_step(index(settings_.visual_substeps), task.length, out);
  out.live.back().assign(tracker_.live().begin(), tracker_.live().end());
  add_sleeping(out.live.back());
  record_trajectories(out);
  update_sleeping(task.length);
  out.end = motions_;
  out.asleep = static_cast<std::int64_t>(sleeping_.count());
}

}  // namespace tactus::sim
