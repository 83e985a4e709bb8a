#include "haptic_node/contact/touch_pages.h"

#include <algorithm>
#include <utility>

namespace tactus::haptic {

const touch_model_t* TouchPages::add(touch_model_t page) {
  repeated_ = false;
  if (page.pages <= 1) {
    whole_ = std::move(page);
    return &whole_;
  }
  const int number = page.page, count = page.pages;
  const Key key{page.header.incarnation, page.header.sim_time_ns, page.header.seq - number, count};
  auto* group = pages_.add(key, number, count, std::move(page));
  repeated_ = pages_.repeated();
  if (!group) return nullptr;
  auto next = group->pages.begin();
  whole_ = std::move(next->page);
  for (++next; next != group->pages.end(); ++next) {
    const touch_model_t& m = next->page;
    whole_.planes.insert(whole_.planes.end(), m.planes.begin(), m.planes.end());
    whole_.applied.insert(whole_.applied.end(), m.applied.begin(), m.applied.end());
  }
  whole_.page = 0;
  whole_.pages = 1;
  whole_.plane_count = static_cast<std::int8_t>(std::min<std::size_t>(127, whole_.planes.size()));
  whole_.applied_count = static_cast<std::int8_t>(std::min<std::size_t>(127, whole_.applied.size()));
  return &whole_;
}

}  // namespace tactus::haptic
