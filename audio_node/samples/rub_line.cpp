#include "audio_node/samples/rub_line.h"

#include "audio_node/samples/loops.h"

namespace tactus::audio {
namespace {

// Design: four times the audible contacts; older ones have faded by themselves.
constexpr std::size_t kMaxOwed = 4 * Loops::kMax;

}  // namespace

bool RubLine::submit(const RecordedContact& rub) {
  std::erase_if(owed_, [&](const RecordedContact& end) { return end.contact == rub.contact && end.part == rub.part; });
  tell_ends();
  if (queue_.push(rub)) return true;
  if (!rub.ends) return ++lost_, false;
  owed_.push_back(rub);
  if (owed_.size() > kMaxOwed) owed_.pop_front(), ++lost_;
  return false;
}

void RubLine::tell_ends() {
  while (!owed_.empty() && queue_.push(owed_.front())) owed_.pop_front();
}

}  // namespace tactus::audio
