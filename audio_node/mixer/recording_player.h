// All recordings that currently sound: the part that runs in the callback.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "audio_node/samples/loops.h"
#include "audio_node/samples/shots.h"
#include "audio_node/mixer/scheduler.h"
#include "audio_node/signal/spsc.h"

namespace tactus::audio {

// Maximum number of contact updates that wait for their sample at a time; in each, all audible contacts may begin
// and the same number end (Output::update_interval).
inline constexpr int kMaxQueuedUpdates = 64;

// Queues between the loop of the node and the callback, in addition to strikes.
struct RecordedQueues {
  Spsc<RecordedContact> contacts{kMaxQueuedUpdates * 2 * Loops::kMax};
  // Strikes and contacts queued after an entry belong to the database of that number.
  Spsc<std::int64_t> databases{16};
  // The callback holds nothing of a database with a lower number, and will receive nothing: those may be freed.
  std::atomic<std::int64_t> oldest_held{0};
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
};

// Call on the loop thread while there is no callback and none is being made: releases all but the newest database.
void release_unused(RecordedQueues& queues);

// Realtime-safe: yes, except the constructor.
class RecordingPlayer {
 public:
  RecordingPlayer(RecordedQueues& queues, double rate_Hz, const Space& space = {},
           Instructions instructions = Instructions::kSse2)
      : queues_(queues),
        shots_(rate_Hz, space, instructions),
        loops_(rate_Hz, space, instructions),
        database_(queues.oldest_held.load()) {}

  // Sounding recordings keep their place in the world.
  void set_listener(const Listener& listener) { shots_.set_listener(listener), loops_.set_listener(listener); }

  // Call at the beginning of a block, before strikes are taken.
  void receive_databases();
  void begin(const Strike& strike, float gain, int offset) { shots_.start(strike.recorded, gain, offset); }
  // Adds `frames` frames, channels interleaved, the first of which is presented at `first`. Returns the number of
  // contacts that began to scrape or roll.
  int render(float* mix, int frames, sync::HostTime first);
  // Call at the end of a block. waiting: strikes that have not begun.
  void release(const Scheduler& waiting);
  // Stops all recordings; no strike waits.
  void abandon(const Scheduler& waiting);

  // Stops all recordings at once.
  void clear() { shots_.clear(), loops_.clear(); }
  int active() const { return shots_.active() + loops_.active(); }

 private:
  int receive_contacts(sync::HostTime until);

  RecordedQueues& queues_;
  Shots shots_;
  Loops loops_;
  std::optional<RecordedContact> next_;  // taken from the queue, not yet due
  std::int64_t database_;    // newest number
};

}  // namespace tactus::audio
