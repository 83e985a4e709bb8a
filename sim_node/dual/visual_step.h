// What the two groups of a dual simulation hand to each other, by value: a task for the visual group, and the step
// that comes of it. Plain data; kept and swapped, so that nothing is allocated once the lists have grown.
#pragma once

#include <cstdint>
#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <utility>
#include <vector>

#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/contacts/contact_tracker.h"
#include "sim_node/dual/swept_trajectories.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

// Some units, and the contacts in which they are.
struct Handover {
  std::vector<int> units;  // ascending
  std::vector<impulse::UnitState> states;
  std::vector<LiveContact> contacts;
  void clear() { units.clear(), states.clear(), contacts.clear(); }
  // Where a unit is in it; -1: nowhere.
  int find(int unit) const;
  // most: units of the world. tracker: of the world whose contacts these are.
  void archive(StateArchive& a, int most, std::size_t bodies, ContactTracker& tracker);
};

// Moves the instants of a contact to another clock.
void shift(LiveContact& contact, sync::Nanoseconds by);

struct VisualTask {
  std::int64_t number = 0;     // of the step
  sync::Nanoseconds length{};  // of the step
  sync::Nanoseconds missed{};  // of the step before, at whose beginning those that enter left the haptic group
  Handover enters;             // as they were then
  std::vector<int> leaves;     // units that are in the haptic group by now
  std::vector<impulse::SceneChange> changes;  // that hold from its beginning on

  void archive(StateArchive& a, int units, std::size_t bodies, ContactTracker& tracker);
};

// One visual step, from `begins` on the clock of the visual group.
struct VisualStep {
  VisualTask task;
  sync::SimTime begins{};
  std::vector<int> units, bodies;        // of the group, ascending
  std::vector<sync::Nanoseconds> times;  // at which sub-steps begin, from `begins` on, and the end
  // At each of them: every unit of the group, and the contacts.
  std::vector<std::vector<impulse::UnitState>> states;
  std::vector<std::vector<LiveContact>> live;
  std::vector<BodyMotion> begin, end;   // of every body of the world; of those not in the group nothing is known
  SweptTrajectories ways;                            // from the beginning on
  std::vector<contact_event_t> events;  // on that clock; those of who entered are from the step before
  std::int64_t asleep = 0;              // bodies that rested and were not computed

  // The newest of times that is not after `passed`.
  std::size_t time_before(sync::Nanoseconds passed) const;
  // units, bodies: of the world. tracker: of the world whose contacts these are.
  void archive(StateArchive& a, int units, std::size_t bodies, ContactTracker& tracker);
  // The names of contacts and events are of another incarnation.
  void rename(const Ids& ids);
};

}  // namespace tactus::sim
