// Cuts lists into pages, messages that fit one datagram. Pure.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"

namespace tactus::sim {

// Ranges [begin, end) of `items` such that a message with `base_bytes` in addition fits. At least one range, so that
// an empty list is published too.
template <class Item>
std::vector<std::pair<std::size_t, std::size_t>> paged(const std::vector<Item>& items, std::size_t base_bytes) {
  std::vector<std::pair<std::size_t, std::size_t>> pages;
  std::size_t begin = 0, bytes = base_bytes;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::size_t size = static_cast<std::size_t>(items[i]._getEncodedSizeNoHash());
    if (i > begin && bytes + size > channels::kMaxMessageBytes) {
      pages.emplace_back(begin, i);
      begin = i;
      bytes = base_bytes;
    }
    bytes += size;
  }
  pages.emplace_back(begin, items.size());
  return pages;
}

// Size in bytes of a message without items.
template <class Message>
std::size_t empty_size() {
  static const std::size_t size = static_cast<std::size_t>(Message{}.getEncodedSize());
  return size;
}

}  // namespace tactus::sim
