#include "sync/node/tag_table.h"

#include <algorithm>

namespace tactus::sync {

void TagTable::push(const tag_list_t& m) {
  const std::pair key{m.header.incarnation, m.list};
  if (!lists_.contains(key) && lists_.size() >= kMaxLists)
    lists_.erase(std::min_element(lists_.begin(), lists_.end(),
                                  [](const auto& a, const auto& b) { return a.second.received_order < b.second.received_order; }));
  List& list = lists_[key];
  list.node = m.node;
  list.received_order = ++received_;
  list.tags.resize(static_cast<std::size_t>(m.total));
  std::copy(m.tags.begin(), m.tags.end(), list.tags.begin() + m.first);
}

}  // namespace tactus::sync
