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
  kNewEpoch,        // the same incarnation, its clock back by more than 1 s: a log replayed anew
};

// Keyed by source; keeps the newest incarnation of each.
class SequenceTracker {
 public:
  Arrival observe(const header_t& header);
  std::int64_t gaps() const { return gaps_; }
  std::int64_t messages() const { return messages_; }

 private:
  struct Sender {
    std::int64_t incarnation = 0;
    std::int64_t seq = 0;
    std::int64_t publish_ns = 0;
    std::set<std::int64_t> missing{};  // the newest kRemembered of them: a late one closes its gap, a repeated one none
  };
  static constexpr std::int64_t kRemembered = 256;
  std::map<std::int32_t, Sender> senders_;
  std::int64_t gaps_ = 0;
  std::int64_t messages_ = 0;
};

}  // namespace tactus::sync
