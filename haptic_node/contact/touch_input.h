// Input of the touch models of one tool, page by page: the newest complete model, its arrival, and its map between
// simulated time and the host clock. Pure.
#pragma once

#include <optional>
#include <tactus/touch_model_t.hpp>
#include <utility>

#include "haptic_node/contact/touch_pages.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "sync/time/time.h"

namespace tactus::haptic {

class TouchInput {
 public:
  // own: messages of another clock are converted through its map; those of another run by arrival.
  TouchInput(int tool, sync::OwnClock own) : tool_(tool), simulation_(own) {}

  // A page. Ignores pages of other tools, of a replaced simulation, older pages, and pages of an impossible future
  // time.
  void push(touch_model_t page, sync::HostTime arrival);
  // The newest model, once; otherwise none. Valid until the next push.
  TouchModelView pop() { return std::exchange(fresh_, false) ? newest_ : TouchModelView{}; }
  // When the newest arrived, with its last page; nothing: none yet.
  std::optional<sync::HostTime> arrival() const { return arrival_; }
  // Time since which newer pages have arrived without completing a model; empty: the newest page completed one. A
  // page that never arrives is a loss, even when other pages arrive.
  std::optional<sync::HostTime> unfinished_since() const { return unfinished_since_; }
  std::optional<sync::TimeMap> map(sync::HostTime now) const { return simulation_.map(now); }
  // True once after the simulation has begun again, when models of the one before have been returned.
  bool take_restart() { return std::exchange(new_world_, false); }

 private:
  int tool_;
  sync::SimClockTracker simulation_;
  TouchPages pages_;
  TouchModelView newest_;
  std::optional<sync::HostTime> arrival_, unfinished_since_;
  bool fresh_ = false;
  bool new_world_ = false;
  bool restarted_ = false;  // no model of the new incarnation is complete yet: older instants then count as newer
};

}  // namespace tactus::haptic
