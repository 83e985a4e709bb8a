#include "audio_node/samples/recorded_contact_queue.h"

#include "audio_node/samples/loops.h"

namespace tactus::audio {
namespace {

// Design: four times the audible contacts; older ones have faded by themselves.
constexpr std::size_t kMaxPendingEnds = 4 * Loops::kMax;

}  // namespace

bool RecordedContactQueue::submit(const RecordedContact& contact) {
  std::erase_if(pending_ends_, [&](const RecordedContact& end) { return end.contact == contact.contact && end.part == contact.part; });
  send_ends();
  if (queue_.push(contact)) return true;
  if (!contact.ends) return ++lost_, false;
  pending_ends_.push_back(contact);
  if (pending_ends_.size() > kMaxPendingEnds) pending_ends_.pop_front(), ++lost_;
  return false;
}

void RecordedContactQueue::send_ends() {
  while (!pending_ends_.empty() && queue_.push(pending_ends_.front())) pending_ends_.pop_front();
}

}  // namespace tactus::audio
