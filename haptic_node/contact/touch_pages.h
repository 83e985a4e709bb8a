// Reassembles touch models from pages. Only complete models are returned: pages of two steps are never mixed, and
// a newer complete model replaces an incomplete one. Pure.
#pragma once

#include <cstdint>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/contact/touch_model_view.h"
#include "sync/bus/page_assembler.h"

namespace tactus::haptic {

class TouchPages {
 public:
  // Number of incomplete models, since pages of one step and the next may overtake each other; the oldest is
  // dropped beyond that. Design: two steps, and two more of a reordering profile.
  static constexpr std::size_t kMaxPartialModels = 4;
  // Larger models are ignored.
  static constexpr int kMaxPages = TouchModelView::kMaxPages;

  TouchPages() = default;
  TouchPages(const TouchPages&) = delete;  // views point into it
  TouchPages& operator=(const TouchPages&) = delete;

  // Adds a page. Returns the model that it completes, valid until the next complete one; otherwise none. Repeated
  // pages change nothing. Realtime-safe once the lists have grown.
  TouchModelView add(touch_model_t page);
  // True when the last page belonged to a model that was complete already.
  bool repeated() const { return repeated_; }
  // Drops all incomplete models.
  void clear() { pages_.clear(); }

 private:
  // Sequence number minus page index is the sequence number of the first page. It distinguishes models of one
  // instant while the simulation is paused.
  struct Key {
    std::int64_t incarnation = 0, sim_time_ns = 0, first_seq = 0;
    int pages = 0;
    bool operator==(const Key&) const = default;
  };
  sync::PageAssembler<touch_model_t, Key> pages_{
      {.groups = kMaxPartialModels, .pages = kMaxPages, .remembered = kMaxPartialModels}};
  touch_model_t single_{};  // the newest complete model, if it has one page
  bool repeated_ = false;
};

}  // namespace tactus::haptic
