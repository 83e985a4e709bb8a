// The slow state, contacts between bodies and poses of bodies, taken now and then, cut into pages, and handed out
// as the scheduler says. Pure.
//
// Of bodies that are computed ahead, a visual step at a time, the state at the step's end is told when the step
// begins, so that pictures are interpolated. One that is taken out of them (promoted) is told at once where it is,
// and nothing more goes out of what was foreseen of it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/world_state_t.hpp>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/ahead.h"
#include "sim_node/publish/page_scheduler.h"

namespace tactus::sim {

// What is read when a snapshot is taken.
struct StateSource {
  // Of every body at the present step; of those computed ahead, and those that wait for it, at the beginning of
  // the visual step that runs; while they are held, at the end of the last.
  std::span<const BodyMotion> bodies;
  std::function<void(std::vector<contact_t>&)> contacts;  // of the group OTHER; clears the list first
  const Ahead* ahead = nullptr;                           // null: every body is simulated with every step
};

class Snapshots {
 public:
  static constexpr sync::Nanoseconds kFullPeriod{1'000'000'000};
  // Snapshots are taken when a visual step begins; without one for so long, by the clock.
  static constexpr sync::Nanoseconds kNoStep{20'000'000};
  // A promoted body is told again in the snapshots of so long: the page that told of it first may have been lost.
  static constexpr sync::Nanoseconds kToldAgain{50'000'000};

  Snapshots(double rate_Hz, double pages_per_second, sync::Nanoseconds step)
      : scheduler_(rate_Hz, pages_per_second, step) {}

  // One tick at `now`: hands the pages that go out now to one of the two, in order; their clock is not set yet.
  // Bodies that move are in every snapshot, all bodies in one a second. pace: goes on by a step with every tick,
  // also while the world stands still; all rates are in it.
  void tick(sync::SimTime now, sync::SimTime pace, const StateSource& source,
            const std::function<void(contact_frame_t&)>& send_contacts,
            const std::function<void(world_state_t&)>& send_world);
  // Somebody new is listening: every body goes out as soon as the budget allows.
  void want_full() { full_wanted_ = true; }

 private:
  using Pages = std::vector<std::pair<std::size_t, std::size_t>>;
  // One of the two parts of a snapshot: what is told of the present step, and what ahead.
  template <class Item>
  struct Part {
    sync::SimTime time{};
    std::vector<Item> items;
    Pages pages;  // none: nothing is told
  };

  void take_bodies(sync::SimTime now, sync::SimTime pace, const StateSource& source, bool full, bool with_ahead);
  void take_contacts(sync::SimTime now, const StateSource& source);
  void follow(const Ahead& ahead, std::size_t bodies, sync::SimTime pace, bool stands);
  void tell_promoted(sync::SimTime now, const StateSource& source,
                     const std::function<void(world_state_t&)>& send);
  void take_due(sync::SimTime now, sync::SimTime pace, const StateSource& source);
  void take_due_ahead(sync::SimTime now, sync::SimTime pace, const StateSource& source);
  const BodyMotion& present(std::size_t body, sync::SimTime now, const StateSource& source);
  void tell_now(std::size_t body, const BodyMotion& m, bool always);
  void tell_ahead(std::size_t body, const BodyMotion& m, const BodyMotion& now, bool always);
  void fill(world_state_t& page);
  void fill(contact_frame_t& page);

  PageScheduler scheduler_;
  bool full_wanted_ = true;
  std::optional<sync::SimTime> last_full_;

  bool full_ = false;
  Part<body_state_t> bodies_, bodies_ahead_;
  Part<contact_t> contacts_, contacts_ahead_;
  std::size_t sent_bodies_ = 0, sent_contacts_ = 0;
  std::vector<BodyMotion> told_;  // of each body, as last put into a snapshot
  std::vector<char> moved_;       // of each body: it moved when it was last looked at
  // Only with bodies computed ahead.
  std::optional<sync::SimTime> last_now_;
  BodyMotion present_;
  bool bodies_pending_ = false, contacts_pending_ = false, held_ = false;
  sync::SimTime taken_bodies_{}, taken_contacts_{};
  std::vector<char> ahead_;                // of each body: it was told ahead last
  std::vector<char> gone_;                 // of each body: promoted since the snapshot was taken
  std::vector<sync::SimTime> told_until_;  // of each body: told again until then
  std::vector<int> promoted_;              // not yet told
  world_state_t world_page_{};
  contact_frame_t contact_page_{};
};

}  // namespace tactus::sim
