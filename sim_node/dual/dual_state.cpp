// The state of both groups as bytes, with the visual step that is going on and the one that comes next.
#include <algorithm>

#include "sim_node/dual/dual_groups.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxContacts = 1 << 16;  // as of a tracker
constexpr std::size_t kMaxLoads = 1 << 12, kMaxChanges = 1 << 12;

}  // namespace

void DualGroups::archive(StateArchive& a) {
  const int units = world_->units();
  const std::size_t bodies = motions_.size();
  step_->archive(a, units, bodies, tracker_);
  // The next step has been asked for: it is finished first.
  VisualStep& next = visual_.finish();
  visual_.group().archive(a);
  next.archive(a, units, bodies, tracker_);
  world_->archive(a);
  tracker_.archive(a, bodies);
  grouping_.archive(a);
  grouping_.resume(step_->ways);
  rate_.archive(a);
  late_.archive(a, units, bodies, tracker_);
  a(begins_), a(ends_), a(held_until_), a(number_), a(late_steps_), a(held_ticks_), a(began_), a(holds_);
  ahead_ = begins_ - step_->begins;
  std::int64_t told = static_cast<std::int64_t>(told_);
  a(told);
  a.require(told >= 0 && told <= static_cast<std::int64_t>(step_->events.size()),
            "the state holds a number out of range");
  told_ = static_cast<std::size_t>(told);
  a.list(loads_, kMaxLoads, [&](Load& load) {
    a.index(load.body, bodies);
    a.require(load.body >= 0, "the state holds a push of nothing");
    a(load.force_N), a(load.point_m), a(load.torque_N_m), a(load.at_centre);
  });
  a.list(changes_, kMaxChanges, [&](impulse::SceneChange& c) { c.archive(a, bodies); });
  a.list(wishes_, kMaxLoads, [&](Wish& w) {
    a(w.kind), a.index(w.body, bodies), a(w.vector), a(w.turn);
    a.require(w.body >= 0 && w.kind >= Wish::kPose && w.kind <= Wish::kSpin,
              "the state holds a number out of range");
  });
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
  a.list(contacts_, kMaxContacts, [&](Manifold& m) { sim::archive(a, m, bodies, source_.shapes()); });
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
  for (LiveContact& c : late_.contacts) c.id = ids_.renamed(c.id);
}

}  // namespace tactus::sim
