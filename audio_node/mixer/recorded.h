// All recordings that sound just now: the callback's part of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "audio_node/samples/loops.h"
#include "audio_node/samples/shots.h"
#include "audio_node/mixer/scheduler.h"
#include "audio_node/signal/spsc.h"

namespace tactus::audio {

// Contacts are told so often that no more tellings than these wait for their sample at a time, and in each all
// that can be heard begin and as many end (Output::tell_every).
inline constexpr int kTellings = 64;

// What crosses between the node's loop and the callback besides strikes.
struct RecordedQueues {
  Spsc<RecordedContact> rubs{kTellings * 2 * Loops::kMax};
  // Strikes and rubs that cross after one of these are of the database of that number.
  Spsc<std::int64_t> databases{16};
  // The callback holds nothing of a database of a number below this, and will never again: it may go.
  std::atomic<std::int64_t> let_go{0};
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
};

// Where no callback is and none is being made, the loop says in its place that nothing is held but the newest.
void let_go_unheard(RecordedQueues& crossing);

// Realtime-safe: yes, all but the constructor.
class Recorded {
 public:
  Recorded(RecordedQueues& crossing, double rate_Hz, const Space& space = {},
           Instructions instructions = Instructions::kSse2)
      : crossing_(crossing),
        shots_(rate_Hz, space, instructions),
        loops_(rate_Hz, space, instructions),
        database_(crossing.let_go.load()) {}

  // What sounds stays where it is in the world.
  void hear_from(const Listener& listener) { shots_.hear_from(listener), loops_.hear_from(listener); }

  // At the beginning of a call, before strikes are taken.
  void take_databases();
  void begin(const Strike& strike, float gain, int offset) { shots_.take(strike.recorded, gain, offset); }
  // Adds `frames` frames, channels interleaved, the first of which is heard at `first`. Returns how many
  // contacts began to scrape or roll.
  int render(float* mix, int frames, sync::HostTime first);
  // At the end of a call. waiting: strikes that have not begun.
  void let_go(const Scheduler& waiting);
  // Nothing of it will sound any more; no strike waits.
  void abandon(const Scheduler& waiting);

  int active() const { return shots_.active() + loops_.active(); }

 private:
  int take_rubs(sync::HostTime until);

  RecordedQueues& crossing_;
  Shots shots_;
  Loops loops_;
  std::optional<RecordedContact> next_;  // taken, but not yet to be heard
  std::int64_t database_;    // newest number
};

}  // namespace tactus::audio
