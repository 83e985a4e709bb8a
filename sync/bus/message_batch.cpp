#include "sync/bus/message_batch.h"

namespace tactus::sync {

bool MessageBatch::add(HostTime arrival, const ChannelBytes& m, std::size_t max_bytes) {
  if (bytes() + sizeof(Entry) + m.channel.size() + m.data.size() > max_bytes) return false;
  entries_.push_back({arrival, static_cast<std::uint32_t>(m.channel.size()),
                      static_cast<std::uint32_t>(m.data.size()), bytes_.size(), m.complete});
  bytes_.insert(bytes_.end(), m.channel.begin(), m.channel.end());
  bytes_.insert(bytes_.end(), m.data.begin(), m.data.end());
  return true;
}

void MessageBatch::clear() {
  entries_.clear();
  bytes_.clear();
}

MessageBatch::Message MessageBatch::operator[](std::size_t i) const {
  const Entry& e = entries_[i];
  const std::uint8_t* start = bytes_.data() + e.at;
  return {
      {{reinterpret_cast<const char*>(start), e.channel_bytes}, {start + e.channel_bytes, e.data_bytes}, e.complete},
      e.arrival};
}

}  // namespace tactus::sync
