#include "sync/log/duplicate_finder.h"

#include <algorithm>
#include <cstring>

#include "lcmtypes/channels.h"
#include "sync/log/recorder_types.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kMaxRemembered = 1 << 20;  // messages of the head, and messages without a number
constexpr std::int64_t kOvertaken = 1024;        // numbers before the first one that may still arrive

// Eight bytes at a time: a log of gigabytes is hashed at the speed of its memory. Multiplier: 2^64 divided by the golden ratio
// (Knuth, The Art of Computer Programming, volume 3, section 6.4).
std::uint64_t hashed(std::uint64_t hash, const void* data, std::size_t size) {
  constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15;
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  const auto mix = [&](std::uint64_t word) {
    hash = (hash ^ word) * kMultiplier;
    hash ^= hash >> 32;
  };
  for (; size >= 8; size -= 8, bytes += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes, 8);
    mix(word);
  }
  std::uint64_t rest = 0;
  if (size > 0) std::memcpy(&rest, bytes, size);
  mix(rest);
  mix(size);
  return hash;
}

std::uint64_t hash_of(const LogEvent& event) {
  return hashed(hashed(0, event.channel.data(), event.channel.size()), event.data.data(), event.data.size());
}

}  // namespace

bool is_head_channel(std::string_view channel) {
  return channel == channels::kLogInfo || channel == kLogTypes || channel == channels::kSceneManifest || channel == channels::kAssetChunk;
}

std::uint64_t DuplicateFinder::stream_of(const LogEvent& event, const header_t& header) {
  const std::int64_t sender[] = {header.source, header.incarnation, header.run_id};
  return hashed(hashed(0, event.channel.data(), event.channel.size()), sender, sizeof sender);
}

Copy DuplicateFinder::observe(const LogEvent& event, const header_t& header) {
  if (is_head_channel(event.channel)) {
    if (head_.size() >= kMaxRemembered) head_.clear();
    return head_.insert(hash_of(event)).second ? Copy::kFirst : Copy::kDuplicate;
  }
  const std::uint64_t key = stream_of(event, header);
  auto it = streams_.find(key);
  if (it == streams_.end()) {
    if (streams_.size() >= kMaxStreams) return Copy::kFirst;
    it = streams_.emplace(key, Stream{std::max<std::int64_t>(0, header.seq - kOvertaken), {}, 0}).first;
  }
  Stream& stream = it->second;
  const std::int64_t index = header.seq - stream.first_seq;
  if (index < 0 || index - static_cast<std::int64_t>(stream.hashes.size()) > kMaxGap) {
    if (++stream.beyond >= kMaxContradictions) stream = {std::max<std::int64_t>(0, header.seq - kOvertaken), {}, 0};
    return Copy::kFirst;
  }
  stream.beyond = 0;
  const auto hash = static_cast<std::uint32_t>(hashed(0, event.data.data(), event.data.size()) | 1);
  const auto at = static_cast<std::size_t>(index);
  if (at >= stream.hashes.size()) stream.hashes.resize(at + 1, 0);
  if (stream.hashes[at] == 0) {
    stream.hashes[at] = hash;
    return Copy::kFirst;
  }
  return stream.hashes[at] == hash ? Copy::kDuplicate : Copy::kContradiction;
}

std::int64_t DuplicateFinder::observe_plain(const LogEvent& event) {
  if (plain_.size() >= kMaxRemembered) plain_.clear();
  const auto [it, first] = plain_.try_emplace(hash_of(event), Plain{event.timestamp_us, 0});
  Plain& plain = it->second;
  if (first) return 0;
  plain.count = event.timestamp_us - plain.newest_us > kMaxDelay_us ? 0 : plain.count + 1;
  plain.newest_us = event.timestamp_us;
  return plain.count;
}

}  // namespace tactus::sync
