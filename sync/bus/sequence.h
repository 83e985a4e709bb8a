// Counts missing messages of a channel by sequence number, and distinguishes restarts of a sender from losses.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <tactus/header_t.hpp>

namespace tactus::sync {

enum class SequenceStatus {
  kNew,             // the next number, or after a gap that has been counted
  kOld,             // a repetition, or overtaken by a newer one
  kNewIncarnation,  // the sender was restarted, or is received for the first time
  // The same incarnation, with a clock back by more than 1 s or a different numbering: a log is replayed again.
  kNewEpoch,
};

// Keyed by source; keeps the newest incarnation of each. No message, with any number, can make all later messages count as
// old.
class SequenceTracker {
 public:
  // Larger than any loss: 1000 s at 1 kHz.
  static constexpr std::int64_t kMaxGap = 1'000'000;
  // A sender numbers and stamps its messages in one order. When this number of messages in a row have an older number but a
  // newer stamp than the newest message, the number of that message was wrong.
  static constexpr int kMaxContradictions = 3;
  static constexpr std::size_t kMaxSenders = 256;
  // A late message no longer corrects the count when this number of newer ones has been sent: 1 s at 1 kHz. The memory of a
  // sender does not depend on what it sends.
  static constexpr std::int64_t kRemembered = 1024;

  SequenceStatus observe(const header_t& header);
  std::int64_t gaps() const { return gaps_; }
  std::int64_t messages() const { return messages_; }
  // Removed senders: when there are too many, the one that is silent for longest is removed.
  std::int64_t forgotten() const { return forgotten_; }

 private:
  struct Sender {
    std::int64_t incarnation = 0;
    std::int64_t seq = 0;
    std::int64_t publish_ns = 0;
    std::bitset<kRemembered> missing{};  // bit i: the number seq - 1 - i is missing; a late message clears its bit
    int contradictions = 0;
    std::int64_t last_message = 0;  // messages_ at its newest message
  };
  Sender& find_or_add(std::int32_t source);
  std::map<std::int32_t, Sender> senders_;
  std::int64_t gaps_ = 0;
  std::int64_t messages_ = 0;
  std::int64_t forgotten_ = 0;
};

}  // namespace tactus::sync
