#include "haptic_node/contact/touch_pages.h"

#include <algorithm>

namespace tactus::haptic {

TouchPages::Set& TouchPages::set_of(const Key& key) {
  for (Set& s : sets_)
    if (s.used > 0 && s.key == key) return s;
  Set& oldest =
      *std::min_element(sets_.begin(), sets_.end(), [](const Set& a, const Set& b) { return a.used < b.used; });
  oldest.key = key;
  oldest.has.reset();
  oldest.used = count_;
  return oldest;
}

const touch_model_t* TouchPages::add(const touch_model_t& page) {
  repeated_ = false;
  if (page.pages <= 1) {
    whole_ = page;
    return &whole_;
  }
  if (page.pages > kMaxPages) return nullptr;
  ++count_;
  const Key key{page.header.incarnation, page.header.sim_time_ns, page.header.seq - page.page, page.pages};
  repeated_ = std::find(done_.begin(), done_.end(), key) != done_.end();
  if (repeated_) return nullptr;
  Set& set = set_of(key);
  const auto number = static_cast<std::size_t>(page.page);
  set.page[number] = page;
  set.has.set(number);
  if (set.has.count() < static_cast<std::size_t>(key.pages)) return nullptr;
  whole_ = set.page[0];
  for (std::size_t i = 1; i < static_cast<std::size_t>(key.pages); ++i) {
    const touch_model_t& m = set.page[i];
    whole_.planes.insert(whole_.planes.end(), m.planes.begin(), m.planes.end());
    whole_.applied.insert(whole_.applied.end(), m.applied.begin(), m.applied.end());
  }
  whole_.page = 0;
  whole_.pages = 1;
  whole_.plane_count = static_cast<std::int8_t>(std::min<std::size_t>(127, whole_.planes.size()));
  whole_.applied_count = static_cast<std::int8_t>(std::min<std::size_t>(127, whole_.applied.size()));
  set.used = 0;
  done_[next_done_] = key;
  next_done_ = (next_done_ + 1) % done_.size();
  return &whole_;
}

void TouchPages::clear() {
  for (Set& s : sets_) s.used = 0;
}

}  // namespace tactus::haptic
