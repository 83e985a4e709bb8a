// Counts what is missing in the numbering of one channel and tells restarts from losses.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <tactus/header_t.hpp>
#include <utility>

namespace tactus::sync {

enum class Arrival {
  kNew,             // next, or after a gap that has been counted
  kOld,             // a repetition, or overtaken by a newer one
  kNewIncarnation,  // the sender was restarted (or is heard for the first time)
  kNewEpoch,  // the same incarnation, its clock back by more than 1 s or its numbering elsewhere: a log replayed
              // anew
};

// Keyed by source; keeps the newest incarnation of each. No message, whatever its number, makes all that follow it
// old.
class SequenceTracker {
 public:
  // No loss is as long: 1000 s of 1 kHz.
  static constexpr std::int64_t kLongestGap = 1'000'000;
  // A sender numbers and stamps in one order. So many messages in a row with an older number and a newer stamp
  // than the newest say that the number of that one was wrong.
  static constexpr int kContradictions = 3;
  static constexpr std::size_t kMaxSenders = 256;

  Arrival observe(const header_t& header);
  std::int64_t gaps() const { return gaps_; }
  std::int64_t messages() const { return messages_; }
  // Senders that had to make room: those not heard for longest.
  std::int64_t forgotten() const { return forgotten_; }

 private:
  struct Sender {
    std::int64_t incarnation = 0;
    std::int64_t seq = 0;
    std::int64_t publish_ns = 0;
    std::set<std::int64_t>
        missing{};  // the newest kRemembered of them: a late one closes its gap, a repeated one none
    int contradictions = 0;
    std::int64_t heard = 0;  // messages_ then
  };
  Sender& find_or_add(std::int32_t source);
  static constexpr std::int64_t kRemembered = 256;
  std::map<std::int32_t, Sender> senders_;
  std::int64_t gaps_ = 0;
  std::int64_t messages_ = 0;
  std::int64_t forgotten_ = 0;
};

}  // namespace tactus::sync
