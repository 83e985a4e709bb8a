// Snapshots of the slow state: contacts between bodies and poses of bodies, cut into pages and sent as the scheduler
// decides. Pure.
//
// For bodies computed ahead, one visual step at a time, the state at the end of the step is published when the step
// begins, so that renderers interpolate. A body that is promoted out of this group is published immediately with
// its current pose, and no further predicted state of it is published.
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
#include "sim_node/model/look_ahead.h"
#include "sim_node/publish/page_scheduler.h"

namespace tactus::sim {

// Data source of a snapshot.
struct StateSource {
  // Motion of every body: at the current step. For bodies computed ahead, and those that wait for it: at the
  // beginning of the current visual step; while they are held: at the end of the last one.
  std::span<const BodyMotion> bodies;
  std::function<void(std::vector<contact_t>&)> contacts;  // of the group OTHER; clears the list first
  const LookAhead* look_ahead = nullptr;                  // null: every body is simulated in every step
};

class Snapshots {
 public:
  static constexpr sync::Nanoseconds kFullPeriod{1'000'000'000};
  // Snapshots are taken when a visual step begins, or by the clock after this time without one.
  static constexpr sync::Nanoseconds kMaxStepGap{20'000'000};
  // A promoted body is repeated in the snapshots of this duration, because the first page may have been lost.
  static constexpr sync::Nanoseconds kRepeatPromoted{50'000'000};

  Snapshots(double rate_Hz, double pages_per_second, sync::Nanoseconds step)
      : scheduler_(rate_Hz, pages_per_second, step) {}

  // One tick at `now`: passes the due pages to one of the two functions, in order, without their clock. Every
  // snapshot contains the moving bodies; one per second contains all bodies. pace: advances by one step per tick,
  // also during a pause; all rates refer to it.
  void tick(sync::SimTime now, sync::SimTime pace, const StateSource& source,
            const std::function<void(contact_frame_t&)>& send_contacts,
            const std::function<void(world_state_t&)>& send_world);
  // A new receiver has appeared: every body is sent as soon as the budget allows.
  void request_full() { full_requested_ = true; }

 private:
  using Pages = std::vector<std::pair<std::size_t, std::size_t>>;
  // One of the two parts of a snapshot: the current state, and the state ahead.
  template <class Item>
  struct Part {
    sync::SimTime time{};
    std::vector<Item> items;
    Pages pages;  // empty: nothing to publish
  };

  void take_bodies(sync::SimTime now, sync::SimTime pace, const StateSource& source, bool full, bool with_ahead);
  void take_contacts(sync::SimTime now, const StateSource& source);
  void update_ahead(const LookAhead& look_ahead, std::size_t bodies, sync::SimTime pace, bool paused);
  void publish_promoted(sync::SimTime now, const StateSource& source,
                     const std::function<void(world_state_t&)>& send);
  void take_due(sync::SimTime now, sync::SimTime pace, const StateSource& source);
  void take_due_ahead(sync::SimTime now, sync::SimTime pace, const StateSource& source);
  const BodyMotion& present(std::size_t body, sync::SimTime now, const StateSource& source);
  void add_present(std::size_t body, const BodyMotion& m, bool always);
  void add_ahead(std::size_t body, const BodyMotion& m, const BodyMotion& now, bool always);
  void fill(world_state_t& page);
  void fill(contact_frame_t& page);

  PageScheduler scheduler_;
  bool full_requested_ = true;
  std::optional<sync::SimTime> last_full_;

  bool full_ = false;
  Part<body_state_t> bodies_, bodies_ahead_;
  Part<contact_t> contacts_, contacts_ahead_;
  std::size_t sent_bodies_ = 0, sent_contacts_ = 0;
  std::vector<BodyMotion> last_published_;  // per body, in the last snapshot
  std::vector<char> moved_;       // per body: it moved at the last check
  // Used only with bodies computed ahead.
  std::optional<sync::SimTime> last_now_;
  BodyMotion present_;
  bool bodies_pending_ = false, contacts_pending_ = false, held_ = false;
  sync::SimTime taken_bodies_{}, taken_contacts_{};
  std::vector<char> ahead_;                // per body: published ahead in the last snapshot
  std::vector<char> gone_;                 // per body: promoted since the snapshot was taken
  std::vector<sync::SimTime> repeat_until_;  // per body: repeated until this time
  std::vector<int> promoted_;              // not published yet
  world_state_t world_page_{};
  contact_frame_t contact_page_{};
};

}  // namespace tactus::sim
