// Puts the pages of touch models together. Only a whole set counts: pages of two steps are never mixed, a set that
// lacks a page is given up for a newer one that is whole, and until then the hand keeps the one before. Pure.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <tactus/touch_model_t.hpp>

namespace tactus::haptic {

class TouchPages {
 public:
  // Sets that may be on their way at once, since pages of one step and the next may overtake each other; of more
  // the oldest is given up. Design: two steps, and what a reordering profile adds.
  static constexpr std::size_t kGathering = 4;
  static constexpr int kMaxPages =
      16;  // design: twice what a tool has, 49 planes of 7 a page; larger sets are ignored

  // Takes a page. When it is the last that its set lacked, the whole model: page 0 of 1, with the planes and books
  // of all pages in their order; valid until the next call. Else null. Repeated pages change nothing.
  // Realtime-safe once the lists have grown.
  const touch_model_t* add(const touch_model_t& page);
  // Whether the page given last was of a set that was whole already.
  bool repeated() const { return repeated_; }
  // Forgets all that are not whole.
  void clear();

 private:
  // A page's number and place give the number of its set's first page: also while the world stands still, when all
  // sets are of one instant.
  struct Key {
    std::int64_t incarnation = 0, sim_time_ns = 0, first_seq = 0;
    int pages = 0;
    bool operator==(const Key&) const = default;
  };
  struct Set {
    Key key;
    std::array<touch_model_t, kMaxPages> page;
    std::bitset<kMaxPages> has;
    std::int64_t used = 0;  // when it was begun, in pages; 0: free
  };
  Set& set_of(const Key& key);

  std::array<Set, kGathering> sets_;
  std::array<Key, kGathering> done_{};  // made whole lately: a page that comes again begins no new set
  std::size_t next_done_ = 0;
  std::int64_t count_ = 0;
  bool repeated_ = false;
  touch_model_t whole_{};
};

}  // namespace tactus::haptic
