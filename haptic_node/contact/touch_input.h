// The touch models of one tool as they arrive, page by page: the newest that is whole, when it arrived, and the
// map between simulated time and the host clock that it carries. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/touch_model_t.hpp>
#include <utility>

#include "haptic_node/contact/touch_pages.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "sync/time/time.h"

namespace tactus::haptic {

class TouchInput {
 public:
  // own: messages of another clock are read through its map; those of another run by arrival.
  TouchInput(int tool, sync::OwnClock own) : tool_(tool), simulation_(own) {}

  // A page. Those of other tools, of a simulation that has been replaced, older ones, and those of a future that
  // nobody can know are ignored.
  void push(touch_model_t page, sync::HostTime arrival);
  // The newest if it has not been taken yet, else none. Valid until the next push.
  TouchModelView take() { return std::exchange(fresh_, false) ? newest_ : TouchModelView{}; }
  // When the newest arrived, with its last page; nothing: none yet.
  std::optional<sync::HostTime> arrival() const { return arrival_; }
  // Since when newer pages have been arriving of which none made a whole model; nothing: the newest page did. A
  // page that never comes through is a loss, however many others arrive.
  std::optional<sync::HostTime> unfinished_since() const { return unfinished_since_; }
  std::optional<sync::TimeMap> map(sync::HostTime now) const { return simulation_.map(now); }

 private:
  int tool_;
  sync::SimClockTracker simulation_;
  TouchPages pages_;
  TouchModelView newest_;
  std::optional<sync::HostTime> arrival_, unfinished_since_;
  bool fresh_ = false;
  bool began_anew_ = false;  // and none of the new life is whole yet: older instants are newer then
};

}  // namespace tactus::haptic
