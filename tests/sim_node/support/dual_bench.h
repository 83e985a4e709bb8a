// A world in two groups with one tool, stepped one tick at a time; repeatable.
#pragma once

#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sim_node/dual/dual_groups.h"
#include "sim_node/dual/group_bodies.h"
#include "tests/sim_node/support/small_worlds.h"

namespace tactus::sim::test {

inline Settings dual_settings() {
  Settings s;
  s.groups = "dual";
  s.visual_thread = "none";
  return s;
}

// Both groups with one tool, one tick at a time.
struct Dual {
  Ids ids{7, 0, 2};
  DualGroups groups;
  std::vector<GroupTool> tools;
  std::vector<contact_event_t> events;
  std::int64_t ticks = 0;

  explicit Dual(const WorldDef& world, const Settings& settings = dual_settings(),
                const Eigen::Vector3d& tool = {0, 0, 50})
      : groups(world, settings, ids), tools{{tool, Eigen::Vector3d::Zero(), 0.01}} {
    groups.start(tools, events);
  }
  sync::SimTime now() const { return sync::sim_time(ticks * 1'000'000); }
  void tick() {
    groups.tick(now(), tools, events);
    ++ticks;
  }
  void run(int n) {
    while (n-- > 0) tick();
  }
  const BodyMotion& body(int i) { return groups.motions()[static_cast<std::size_t>(i)]; }
  int count(std::int8_t kind) const {
    int n = 0;
    for (const contact_event_t& e : events) n += e.kind == kind;
    return n;
  }
};

}  // namespace tactus::sim::test
