#include "audio_node/mixer/recording_player.h"

#include <algorithm>
#include <utility>

namespace tactus::audio {

void release_unused(RecordedQueues& queues) {
  for (RecordedContact r; queues.contacts.pop(r);) continue;
  for (std::int64_t number; queues.databases.pop(number);)
    queues.oldest_held.store(number, std::memory_order_release);
}

void RecordingPlayer::receive_databases() {
  const std::int64_t before = database_;
  for (std::int64_t number; queues_.databases.pop(number);) database_ = number;
  if (database_ == before) return;
  // Contacts of previous databases were queued before; those of the newest follow in a tick.
  if (next_ && next_->database >= database_) return;
  next_.reset();
  for (RecordedContact r; queues_.contacts.pop(r);) {
    if (r.database < database_) continue;
    next_ = r;
    return;
  }
}

// They are queued in the order of presentation; an early one waits.
int RecordingPlayer::receive_contacts(sync::HostTime until) {
  int begun = 0;
  for (RecordedContact r; next_ || queues_.contacts.pop(r);) {
    if (next_) r = *std::exchange(next_, std::nullopt);
    if (r.at > until) {
      next_ = r;
      break;
    }
    begun += loops_.update(r) ? 1 : 0;
  }
  return begun;
}

int RecordingPlayer::render(float* mix, int frames, sync::HostTime first) {
  const int begun = receive_contacts(first);
  shots_.render(mix, frames);
  loops_.render(mix, frames, first);
  return begun;
}

void RecordingPlayer::release(const Scheduler& waiting) {
  if (queues_.oldest_held.load(std::memory_order_relaxed) == database_) return;
  std::int64_t held = loops_.oldest(shots_.oldest(database_));
  if (next_) held = std::min(held, next_->database);
  waiting.for_each([&](const Strike& s) {
    if (s.recorded.database > 0) held = std::min(held, s.recorded.database);
  });
  queues_.oldest_held.store(held, std::memory_order_release);
}

void RecordingPlayer::abandon(const Scheduler& waiting) {
  receive_databases();
  for (RecordedContact r; queues_.contacts.pop(r);) continue;
  next_.reset();
  shots_.clear();
  loops_.clear();
  release(waiting);
}

}  // namespace tactus::audio
