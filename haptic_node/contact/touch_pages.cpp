#include "haptic_node/contact/touch_pages.h"

#include <utility>

namespace tactus::haptic {

TouchModelView TouchPages::add(touch_model_t page) {
  repeated_ = false;
  if (page.pages <= 1) {
    single_ = std::move(page);
    return single_;
  }
  const int number = page.page, count = page.pages;
  const Key key{page.header.incarnation, page.header.sim_time_ns, page.header.seq - number, count};
  const auto* group = pages_.add(key, number, count, std::move(page));
  repeated_ = pages_.repeated();
  TouchModelView whole;
  if (!group) return whole;
  for (const auto& [index, part] : group->pages) whole.add(part);
  return whole;
}

}  // namespace tactus::haptic
