#include "audio_node/mixer/scrape_queue.h"

#include <utility>

namespace tactus::audio {
namespace {

// Maximum number of unsent ends. Design: four times the audible contacts; older ones have faded by themselves.
constexpr std::size_t kMaxPendingEnds = 4 * Scrapes::kMax;

}  // namespace

void ScrapeQueue::set_surfaces(Surfaces next) {
  // Surfaces that no scrape points to may be freed immediately, regardless of the callback.
  if (now_) kept_.push_back({submitted_ > first_ ? submitted_ : 0, std::move(now_)});
  now_ = std::move(next);
  first_ = submitted_;
}

bool ScrapeQueue::submit(Scrape scrape) {
  std::erase(pending_ends_, scrape.id);
  send_ends();
  if (push(scrape)) return true;
  if (!scrape.ends) return ++lost_, false;
  pending_ends_.push_back(scrape.id);
  if (pending_ends_.size() > kMaxPendingEnds) pending_ends_.pop_front(), ++lost_;
  return false;
}

void ScrapeQueue::send_ends() {
  for (; !pending_ends_.empty(); pending_ends_.pop_front()) {
    Scrape end;
    end.id = pending_ends_.front(), end.ends = true;
    if (!push(end)) return;
  }
}

bool ScrapeQueue::push(Scrape& scrape) {
  scrape.number = submitted_;
  if (!queues_.scrapes.push(scrape)) return false;
  ++submitted_;
  return true;
}

std::vector<ScrapeQueue::Surfaces> ScrapeQueue::take_released() {
  std::vector<Surfaces> released;
  if (kept_.empty()) return released;
  const std::int64_t oldest_held = queues_.oldest_held_scrape.load(std::memory_order_acquire);
  std::erase_if(kept_, [&](Kept& k) {
    if (k.end > oldest_held) return false;
    released.push_back(std::move(k.surfaces));
    return true;
  });
  return released;
}

}  // namespace tactus::audio
