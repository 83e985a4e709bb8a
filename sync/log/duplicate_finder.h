// Finds repeated copies of messages in a log, as two loggers of one bus write them into a merged log. Pure.
//
// A sender numbers its messages on each channel, so a message with a known number and the same bytes is a copy, anywhere in the
// log. A message with a known number and other bytes contradicts the first one: it is damaged, or the log holds two runs with
// the same identities, as virtual time gives them to all runs of one seed.
//
// It needs 4 bytes for each message of a log.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <tactus/header_t.hpp>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "sync/log/log_reader.h"

namespace tactus::sync {

enum class Copy : std::uint8_t { kFirst, kDuplicate, kContradiction };

class DuplicateFinder {
 public:
  // Numbers further from the known ones than this are damaged: 1000 s at 1 kHz.
  static constexpr std::int64_t kMaxGap = 1'000'000;
  // After this number of such messages in a row their numbers count as right.
  static constexpr int kMaxContradictions = 3;
  // Messages of further senders and channels are never called copies.
  static constexpr std::size_t kMaxStreams = 65'536;
  // Copies of a message without a number are looked for within this time.
  static constexpr std::int64_t kMaxDelay_us = 60'000'000;

  // A message of this system. The head of a log (LOG_INFO and the scene) has no numbering of its own: it is never a contradiction.
  Copy observe(const LogEvent& event, const header_t& header);
  // The same for all messages of one sender on one channel, which it numbers.
  static std::uint64_t stream_of(const LogEvent& event, const header_t& header);
  // A message of another system, which has no number. Returns how many messages with the same channel and bytes came before it,
  // none of them more than kMaxDelay_us after the previous one; 0: none.
  std::int64_t observe_plain(const LogEvent& event);

 private:
  struct Stream {
    std::int64_t first_seq = 0;
    std::vector<std::uint32_t> hashes;  // by seq - first_seq; 0: unknown
    int beyond = 0;                     // messages in a row with a number out of range
  };
  struct Plain {
    std::int64_t newest_us = 0, count = 0;
  };

  std::unordered_map<std::uint64_t, Stream> streams_;  // by a hash of channel, source, incarnation and run
  std::unordered_set<std::uint64_t> head_;             // hashes of the messages of the head
  std::unordered_map<std::uint64_t, Plain> plain_;     // by a hash of channel and bytes
};

// True for the messages that a recorder writes at the head of a log.
bool is_head_channel(std::string_view channel);

}  // namespace tactus::sync
