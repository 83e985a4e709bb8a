#include "audio_node/scrape_line.h"

#include <utility>

namespace tactus::audio {

void ScrapeLine::change(Surfaces next) {
  // Into which none points nobody reads, whatever the callback does.
  if (now_) kept_.push_back({submitted_ > first_ ? submitted_ : 0, std::move(now_)});
  now_ = std::move(next);
  first_ = submitted_;
}

bool ScrapeLine::submit(Scrape scrape) {
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
