// The slow state, contacts between bodies and poses of bodies, taken now and then, cut into pages, and handed out as the
// scheduler says. Pure.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <tactus/contact_frame_t.hpp>
#include <tactus/world_state_t.hpp>
#include <utility>
#include <vector>

#include "sim_node/behaviour/body_motion.h"
#include "sim_node/publish/page_scheduler.h"

namespace tactus::sim {

// What is read when a snapshot is taken.
struct StateSource {
  std::span<const BodyMotion> bodies;
  std::function<void(std::vector<contact_t>&)> contacts;  // of the group OTHER; clears the list first
};

class Snapshots {
 public:
  static constexpr sync::Nanoseconds kFullPeriod{1'000'000'000};

  Snapshots(double rate_Hz, double pages_per_second, sync::Nanoseconds step)
      : scheduler_(rate_Hz, pages_per_second, step) {}

  // One tick at `now`: hands the pages that go out now to one of the two, in order; their clock is not set yet. Bodies
  // that move are in every snapshot, all bodies in one a second. pace: goes on by a step with every tick, also while the
  // world stands still; all rates are in it.
  void tick(sync::SimTime now, sync::SimTime pace, const StateSource& source, const std::function<void(contact_frame_t&)>& send_contacts,
            const std::function<void(world_state_t&)>& send_world);
  // Somebody new is listening: every body goes out as soon as the budget allows.
  void want_full() { full_wanted_ = true; }

 private:
  void take_bodies(sync::SimTime now, sync::SimTime pace, const StateSource& source, bool full);
  void take_contacts(sync::SimTime now, const StateSource& source);
  void fill(world_state_t& page);
  void fill(contact_frame_t& page);

  PageScheduler scheduler_;
  bool full_wanted_ = true;
  std::optional<sync::SimTime> last_full_;

  sync::SimTime bodies_time_{}, contacts_time_{};
  bool full_ = false;
  std::vector<body_state_t> bodies_;
  std::vector<contact_t> contacts_;
  std::vector<std::pair<std::size_t, std::size_t>> body_pages_, contact_pages_;
  std::size_t sent_bodies_ = 0, sent_contacts_ = 0;
  std::vector<BodyMotion> told_;  // of each body, as last put into a snapshot
  std::vector<char> moved_;       // of each body: it moved when it was last looked at
  world_state_t world_page_{};
  contact_frame_t contact_page_{};
};

}  // namespace tactus::sim
