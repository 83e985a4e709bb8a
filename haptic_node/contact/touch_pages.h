// Reassembles touch models. Only a whole model counts: pages of two steps are never mixed, a model that lacks a page is
// given up for a newer one that is whole, and until then the hand keeps the one before. Pure.
#pragma once

#include <cstdint>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/contact/touch_model_view.h"
#include "sync/bus/page_assembler.h"

namespace tactus::haptic {

class TouchPages {
 public:
  // Models that may be on their way at once, since pages of one step and the next may overtake each other; of more
  // the oldest is given up. Design: two steps, and two more of a reordering profile.
  static constexpr std::size_t kGathering = 4;
  // Larger models are ignored.
  static constexpr int kMaxPages = TouchModelView::kMaxPages;

  TouchPages() = default;
  TouchPages(const TouchPages&) = delete;  // views point into it
  TouchPages& operator=(const TouchPages&) = delete;

  // Takes a page. When it is the last that its model lacked, the whole model, valid until the next whole one. Else none.
  // Repeated pages change nothing. Realtime-safe once the lists have grown.
  TouchModelView add(touch_model_t page);
  // Whether the page given last was of a model that was whole already.
  bool repeated() const { return repeated_; }
  // Forgets all that are not whole.
  void clear() { pages_.clear(); }

 private:
  // A page's number and place give the number of its model's first page: also while the world stands still, when all
  // models are of one instant.
  struct Key {
    std::int64_t incarnation = 0, sim_time_ns = 0, first_seq = 0;
    int pages = 0;
    bool operator==(const Key&) const = default;
  };
  sync::PageAssembler<touch_model_t, Key> pages_{
      {.groups = kGathering, .pages = kMaxPages, .remembered = kGathering}};
  touch_model_t single_{};  // the newest whole one, if it has one page
  bool repeated_ = false;
};

}  // namespace tactus::haptic
