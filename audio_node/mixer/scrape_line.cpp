#include "audio_node/mixer/scrape_line.h"

#include <utility>

namespace tactus::audio {
namespace {

// Maximum number of unsent ends. Design: four times the audible contacts; older ones have faded by themselves.
constexpr std::size_t kMaxOwed = 4 * Scrapes::kMax;

}  // namespace

void ScrapeLine::change(Surfaces next) {
  // Surfaces that no scrape points to may be freed at once, regardless of the callback.
  if (now_) kept_.push_back({submitted_ > first_ ? submitted_ : 0, std::move(now_)});
  now_ = std::move(next);
  first_ = submitted_;
}

bool ScrapeLine::submit(Scrape scrape) {
  std::erase(owed_, scrape.id);
  tell_ends();
  if (push(scrape)) return true;
  if (!scrape.ends) return ++lost_, false;
  owed_.push_back(scrape.id);
  if (owed_.size() > kMaxOwed) owed_.pop_front(), ++lost_;
  return false;
}

void ScrapeLine::tell_ends() {
  for (; !owed_.empty(); owed_.pop_front()) {
    Scrape end;
    end.id = owed_.front(), end.ends = true;
    if (!push(end)) return;
  }
}

bool ScrapeLine::push(Scrape& scrape) {
  scrape.number = submitted_;
  if (!crossing_.scrapes.push(scrape)) return false;
  ++submitted_;
  return true;
}

std::vector<ScrapeLine::Surfaces> ScrapeLine::take_unread() {
  std::vector<Surfaces> unread;
  if (kept_.empty()) return unread;
  const std::int64_t let_go = crossing_.scrapes_let_go.load(std::memory_order_acquire);
  std::erase_if(kept_, [&](Kept& k) {
    if (k.end > let_go) return false;
    unread.push_back(std::move(k.surfaces));
    return true;
  });
  return unread;
}

}  // namespace tactus::audio
