// Data that the two groups of a dual simulation exchange by value: a task for the visual group, and the step that
// results. Plain data; the lists are kept and swapped, so that nothing is allocated once they have grown.
#pragma once

#include <cstdint>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/contacts/contact_tracker.h"
#include "sim_node/dual/swept_trajectories.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

// Units that change groups, with their states and contacts.
struct UnitTransfer {
  std::vector<int> units;  // ascending
  std::vector<impulse::UnitState> states;
  std::vector<LiveContact> contacts;
  void clear() { units.clear(), states.clear(), contacts.clear(); }
  // Index of a unit; -1: not found.
  int find(int unit) const;
  // max_units: units of the world. tracker: of the world that these contacts belong to.
  void archive(StateArchive& a, int max_units, std::size_t bodies, ContactTracker& tracker);
};

// Shifts the times of a contact to another clock.
void shift(LiveContact& contact, sync::Nanoseconds by);

struct VisualTask {
  std::int64_t number = 0;     // of the step
  sync::Nanoseconds length{};  // of the step
  sync::Nanoseconds
      catch_up_time{};  // length of the previous step, at whose beginning the entering units left the haptic group
  UnitTransfer entering;                      // their state at that time
  std::vector<int> leaving;                   // units that are now in the haptic group
  std::vector<impulse::SceneChange> changes;  // valid from the beginning of the step on

  void archive(StateArchive& a, int units, std::size_t bodies, ContactTracker& tracker);
};

// One visual step, from `begins` on the clock of the visual group.
struct VisualStep {
  VisualTask task;
  sync::SimTime begins{};
  std::vector<int> units, bodies;        // of the group, ascending
  std::vector<sync::Nanoseconds> times;  // beginning of each sub-step from `begins` on, and the end
  // For each of `times`: the states of the units of the group, and the contacts.
  std::vector<std::vector<impulse::UnitState>> states;
  std::vector<std::vector<LiveContact>> live;
  std::vector<BodyMotion> begin, end;   // of every body of the world; undefined for bodies outside the group
  SweptTrajectories trajectories;       // from the beginning of the step on
  std::vector<contact_event_t> events;  // on the group's clock; events of entering units are from the previous step
  std::int64_t asleep = 0;              // number of resting bodies that were not computed

  // Index of the last of `times` at or before `passed`.
  std::size_t time_before(sync::Nanoseconds passed) const;
  // units, bodies: of the world. tracker: of the world that these contacts belong to.
  void archive(StateArchive& a, int units, std::size_t bodies, ContactTracker& tracker);
  // Renames contacts and events to another incarnation.
  void rename(const Ids& ids);
};

}  // namespace tactus::sim
