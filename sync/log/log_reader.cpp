#include "sync/log/log_reader.h"

#include <string.h>

#include <algorithm>

#include "sync/bus/datagram.h"

namespace tactus::sync {
namespace {

constexpr std::uint32_t kMaxDataBytes = 1u << 28;  // LCM allows messages of 256 MB

std::uint64_t big_endian(const std::uint8_t* p, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | p[i];
  return value;
}

}  // namespace

bool is_legal_channel(std::string_view name) {
  return !name.empty() && name.size() <= kMaxChannelBytes && name.find('\0') == name.npos;
}

bool LogScanner::sync_at(std::size_t at) const {
  return at + 4 <= bytes_.size() && big_endian(&bytes_[at], 4) == kLogSync;
}

bool LogScanner::follows_at(std::size_t at, std::int64_t number) const {
  return at + 12 <= bytes_.size() && sync_at(at) &&
         big_endian(&bytes_[at + 4], 8) == static_cast<std::uint64_t>(number) + 1;
}

bool LogScanner::event_at(std::size_t at, LogEvent& event) const {
  if (at + kLogEventHeaderBytes > bytes_.size() || !sync_at(at)) return false;
  const std::uint8_t* p = &bytes_[at];
  const std::uint64_t channel_bytes = big_endian(p + 20, 4);
  const std::uint64_t data_bytes = big_endian(p + 24, 4);
  if (channel_bytes < 1 || channel_bytes > kMaxChannelBytes || data_bytes > kMaxDataBytes ||
      at + kLogEventHeaderBytes + channel_bytes + data_bytes > bytes_.size())
    return false;
  event.number = static_cast<std::int64_t>(big_endian(p + 4, 8));
  event.timestamp_us = static_cast<std::int64_t>(big_endian(p + 12, 8));
  event.channel = {reinterpret_cast<const char*>(p) + kLogEventHeaderBytes, channel_bytes};
  event.data = bytes_.subspan(at + kLogEventHeaderBytes + channel_bytes, data_bytes);
  return is_legal_channel(event.channel);
}

std::size_t LogScanner::next_event_after(std::size_t at, std::size_t until) const {
  static constexpr std::uint8_t word[4] = {0xED, 0xA1, 0xDA, 0x01};
  LogEvent ignored;
  while (at < until) {
    // The search is limited to `until`, so that repeated searches in a damaged log stay linear in its length.
    const std::size_t within = std::min(bytes_.size(), until + sizeof word - 1) - at;
    const void* found = memmem(&bytes_[at], within, word, sizeof word);
    if (found == nullptr) return until;
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes_.data());
    if (at < until && event_at(at, ignored)) return at;
    ++at;
  }
  return until;
}

void LogScanner::skip_to(std::size_t at) {
  ++damaged_regions_;
  damaged_bytes_ += static_cast<std::int64_t>(at - at_);
  at_ = at;
}

void LogScanner::seek(std::size_t at) { at_ = next_event_after(std::min(at, bytes_.size()), bytes_.size()); }

void LogScanner::skip_padding() {
  const std::size_t part_begin = (at_ + kLogPartBytes - 1) / kLogPartBytes * kLogPartBytes;
  LogEvent ignored;
  if (part_begin == at_ || !event_at(part_begin, ignored)) return;
  const auto between = bytes_.subspan(at_, part_begin - at_);
  if (std::all_of(between.begin(), between.end(), [](std::uint8_t b) { return b == 0; })) at_ = part_begin;
}

bool LogScanner::next(LogEvent& event) {
  while (at_ < bytes_.size()) {
    if (bytes_[at_] == 0) skip_padding();
    if (!event_at(at_, event)) {
      skip_to(next_event_after(at_ + 1, bytes_.size()));
      continue;
    }
    const std::size_t end = at_ + kLogEventHeaderBytes + event.channel.size() + event.data.size();
    if (!follows_at(end, event.number)) {
      // Either the damage begins after this event, or the length of this event is corrupt and covers intact events. A corrupt
      // length may also end at the beginning of an event, but not of the one with the next number.
      const std::size_t swallowed = next_event_after(at_ + kLogEventHeaderBytes, end);
      if (swallowed < end) {
        skip_to(swallowed);
        continue;
      }
    }
    at_ = end;
    ++events_;
    return true;
  }
  return false;
}

}  // namespace tactus::sync
