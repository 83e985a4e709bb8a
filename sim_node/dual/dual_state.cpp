// The state of both groups as bytes. Of the visual step that is going on they hold what it was computed from: it
// is computed again, to the bit the same.
#include <algorithm>

#include "sim_node/dual/dual_groups.h"
#include "sim_node/state/archive_motion.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMostLoads = 1 << 12, kMostChanges = 1 << 12;
constexpr std::size_t kMostBytes = 1 << 30;

void archive(StateArchive& a, sync::Nanoseconds& t) {
  std::int64_t ns = t.count();
  a(ns);
  a.require(ns >= 0 && ns <= 1'000'000'000, "the state holds a time out of range");
  t = sync::Nanoseconds(ns);
}

void archive_task(StateArchive& a, VisualTask& task, int units, std::size_t bodies, ContactTracker& tracker) {
  a(task.number);
  archive(a, task.length), archive(a, task.missed);
  a.require(task.length > sync::Nanoseconds(0), "the state holds a time out of range");
  task.enters.archive(a, units, bodies, tracker);
  a.list(task.leaves, static_cast<std::size_t>(units), [&](int& unit) {
    a.index(unit, static_cast<std::size_t>(units));
    a.require(unit >= 0, "the state names a body that is not there");
  });
  a.list(task.changes, kMostChanges, [&](impulse::SceneChange& c) { c.archive(a, bodies); });
}

}  // namespace

void DualGroups::archive(StateArchive& a) {
  const int units = world_->units();
  const std::size_t bodies = motions_.size();
  VisualTask going_on = step_->task;
  std::string before(step_->before.begin(), step_->before.end());
  a(before);
  a.require(before.size() <= kMostBytes, "the state is longer than it should be");
  archive_task(a, going_on, units, bodies, tracker_);
  if (a.reads()) {
    VisualGroup& group = visual_.halt();
    const std::vector<std::uint8_t> bytes(before.begin(), before.end());
    StateArchive of_group{std::span<const std::uint8_t>(bytes)};
    group.archive(of_group);
    a.require(of_group.at_end(), "the state is longer than it should be");
    if (rename_to_) {
      group.rename(*rename_to_);
      for (LiveContact& c : going_on.enters.contacts) c.id = ids_.renamed(c.id);
    }
    group.run(going_on, *step_);
  }
  archive_task(a, task_, units, bodies, tracker_);
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
  a.list(loads_, kMostLoads, [&](Load& load) {
    a.index(load.body, bodies);
    a.require(load.body >= 0, "the state holds a push of nothing");
    a(load.force_N), a(load.point_m), a(load.torque_N_m);
  });
  a.list(changes_, kMostChanges, [&](impulse::SceneChange& c) { c.archive(a, bodies); });
  a.list(wishes_, kMostLoads, [&](Wish& w) {
    a(w.kind), a.index(w.body, bodies), a(w.vector), a(w.turn);
    a.require(w.body >= 0 && w.kind >= Wish::kPose && w.kind <= Wish::kSpin,
              "the state holds a number out of range");
  });
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
  if (!a.reads()) return;
  if (rename_to_) {
    tracker_.rename();
    for (Handover* who : {&late_, &task_.enters})
      for (LiveContact& c : who->contacts) c.id = ids_.renamed(c.id);
  }
  promoted_.clear();
  released_.clear();
  activate();
  find_contacts(settings_.step_s);
  visual_.ask(task_);
}

// What has been computed ahead is computed again under the new names.
void DualGroups::rename(std::int64_t incarnation) {
  StateArchive written;
  archive(written);
  rename_to_ = incarnation;
  StateArchive read{std::span<const std::uint8_t>(written.bytes())};
  archive(read);
  rename_to_.reset();
}

}  // namespace tactus::sim
