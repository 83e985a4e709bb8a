// Serializes the state of both groups, with the current visual step and the next one.

#include "sim_node/dual/dual_groups.h"
#include "sim_node/dual/state_limits.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxLoads = 1 << 12;

}  // namespace

void DualGroups::archive(StateArchive& a) {
  const int units = world_->units();
  const std::size_t bodies = motions_.size();
  step_->archive(a, units, bodies, tracker_);
  // The next step has already been requested: finish it first.
  VisualStep& next = visual_.finish();
  visual_.group().archive(a);
  next.archive(a, units, bodies, tracker_);
  world_->archive(a);
  tracker_.archive(a, bodies);
  grouping_.archive(a);
  grouping_.resume(step_->trajectories);
  rate_.archive(a);
  departed_.archive(a, units, bodies, tracker_);
  a(begins_), a(ends_), a(held_until_), a(number_), a(late_steps_), a(held_ticks_), a(began_), a(holding_);
  clock_offset_ = begins_ - step_->begins;
  std::int64_t published = static_cast<std::int64_t>(published_events_);
  a(published);
  a.require(published >= 0 && published <= static_cast<std::int64_t>(step_->events.size()),
            "the state holds a number out of range");
  published_events_ = static_cast<std::size_t>(published);
  a.list(loads_, kMaxLoads, [&](Load& load) {
    a.index(load.body, bodies);
    a.require(load.body >= 0, "the state holds a force on no body");
    a(load.force_N), a(load.point_m), a(load.torque_N_m), a(load.at_centre);
  });
  a.list(changes_, kMaxStoredChanges, [&](impulse::SceneChange& c) { c.archive(a, bodies); });
  a.list(queued_changes_, kMaxLoads, [&](QueuedChange& w) {
    a(w.kind), a.index(w.body, bodies), a(w.vector), a(w.orientation);
    a.require(w.body >= 0 && w.kind >= QueuedChange::kPose && w.kind <= QueuedChange::kSpin,
              "the state holds a number out of range");
  });
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
  a.list(contacts_, kMaxStoredContacts, [&](Manifold& m) { sim::archive(a, m, bodies, source_.shapes()); });
  bool stale = stale_;
  a(stale);
  if (!a.reads()) return;
  promoted_.clear();
  released_.clear();
  activate();
  stale_ = stale;
}

void DualGroups::rename(std::int64_t incarnation) {
  visual_.finish().rename(ids_);
  visual_.group().rename(incarnation);
  step_->rename(ids_);
  tracker_.rename();
  for (LiveContact& c : departed_.contacts) c.id = ids_.renamed(c.id);
}

}  // namespace tactus::sim
