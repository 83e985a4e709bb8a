// Assembles touch models from their pages. Only complete sets count: pages of two steps are never mixed, a newer
// complete set replaces an incomplete one, and until then the previous model stays in use. Pure.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <tactus/touch_model_t.hpp>

namespace tactus::haptic {

class TouchPages {
 public:
  // Sets that may be in transit at once, since pages of successive steps may overtake each other; beyond that the
  // oldest is discarded. Design: two steps, plus the effect of a reordering profile.
  static constexpr std::size_t kGathering = 4;
  static constexpr int kMaxPages =
      16;  // design: twice the number of a tool, 49 planes at 7 a page; larger sets are ignored

  // Adds a page. Returns the complete model when it was the last missing page: page 0 of 1, with the planes and
  // applied impulses of all pages in order, valid until the next call. Otherwise null. Repeated pages change
  // nothing. Realtime-safe once the lists have grown.
  const touch_model_t* add(const touch_model_t& page);
  // True when the last page belonged to a set that was already complete.
  bool repeated() const { return repeated_; }
  // Discards all incomplete sets.
  void clear();

 private:
  // first_seq is the sequence number of the first page, from the number and place of any page. It identifies a set
  // even while the simulation is paused and all sets have the same instant.
  struct Key {
    std::int64_t incarnation = 0, sim_time_ns = 0, first_seq = 0;
    int pages = 0;
    bool operator==(const Key&) const = default;
  };
  struct Set {
    Key key;
    std::array<touch_model_t, kMaxPages> page;
    std::bitset<kMaxPages> has;
    std::int64_t used = 0;  // page count at which the set began; 0: free
  };
  Set& set_of(const Key& key);

  std::array<Set, kGathering> sets_;
  std::array<Key, kGathering> done_{};  // recently completed: a repeated page starts no new set
  std::size_t next_done_ = 0;
  std::int64_t count_ = 0;
  bool repeated_ = false;
  touch_model_t whole_{};
};

}  // namespace tactus::haptic
