// Follows the one sender of an output: of a tool, a device, a thermal display or a simulation.
//
//   SenderStatus   message                                                 receiver
//   kCurrent       the next one of the followed sender                     uses it
//   kFirst         the first one of a sender that is followed from now on  uses it as the start of all sums and ages
//   kOld           a repetition, overtaken, or with an impossible number   ignores it
//   kConflict      of another sender, while the followed one sends         ignores it, names the conflict
//   kForeign       of another run                                          ignores it
//
// A sender is a run and an incarnation. The followed sender keeps the output while it sends: a second one changes nothing for it.
// After a silence the next sender takes over, or the same one continues. A sender that was followed before its successor needs a
// silence of at least kSilence. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tactus/header_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

enum class SenderStatus { kCurrent, kFirst, kOld, kConflict, kForeign };

// Whether the receiver uses a message.
constexpr bool accepted(SenderStatus status) { return status == SenderStatus::kCurrent || status == SenderStatus::kFirst; }

class SingleSender {
 public:
  // Silence after which another sender may take over. Design: three lost reports at 10 Hz, the slowest of these outputs, and
  // 300 lost messages of a tool.
  static constexpr Nanoseconds kSilence{300'000'000};
  static constexpr std::int64_t kAnyRun = 0;
  // A number that grows by more than this is impossible: 1000 s at 1 kHz.
  static constexpr std::int64_t kMaxGap = 1'000'000;
  // A stamp that is older than the newest one by more than this is not one of an overtaken message.
  static constexpr Nanoseconds kMaxStepBack{1'000'000'000};
  // After this number of impossible messages in a row, the newest accepted message counts as the false one.
  static constexpr int kMaxContradictions = 3;

  // run_id: the only run whose messages are accepted; kAnyRun: each. silence: > 0.
  explicit SingleSender(std::int64_t run_id = kAnyRun, Nanoseconds silence = kSilence) : run_id_(run_id), silence_(silence) {}

  // One message of the output. arrival: time of its arrival on the own clock, never decreasing. Thread-safe: no.
  // Realtime-safe: yes.
  SenderStatus on_message(const header_t& header, HostTime arrival);
  // The same for an output with pages or several channels: its messages overtake each other, so their numbers are not compared.
  // Never kOld.
  SenderStatus on_page(const header_t& header, HostTime arrival);

  // Whether another sender has sent within the last `silence`, at least within kSilence.
  bool conflict(HostTime now) const { return conflicts_ > 0 && now - last_conflict_ < std::max(silence_, kSilence); }
  // Whether the followed sender has been silent for `silence` or longer; true before the first message.
  bool silent(HostTime now) const { return silent_for(silence_, now); }
  // Arrival of its newest accepted message; the epoch before the first one.
  HostTime last_arrival() const { return last_arrival_; }
  // Incarnation and run of the followed sender; 0 before the first message.
  std::int64_t incarnation() const { return incarnation_; }
  std::int64_t run_id() const { return followed_run_; }
  // Number of messages of other senders, and of other runs, since the start.
  std::int64_t conflicts() const { return conflicts_; }
  std::int64_t foreign() const { return foreign_; }

 private:
  SenderStatus follow(const header_t& header, HostTime arrival);
  bool silent_for(Nanoseconds time, HostTime now) const { return !known_ || now - last_arrival_ >= time; }
  bool impossible(const header_t& header) const;
  bool repeated(const header_t& header) const { return header.seq <= seq_; }
  SenderStatus accept(const header_t& header, HostTime arrival, SenderStatus status);

  std::int64_t run_id_;
  Nanoseconds silence_;
  static constexpr std::size_t kRemembered = 16;

  bool known_ = false;  // a sender is followed
  std::int64_t incarnation_ = 0, followed_run_ = 0;
  std::array<std::int64_t, kRemembered> former_{};  // incarnations that were followed before
  std::size_t next_former_ = 0;
  std::int64_t seq_ = 0, publish_ns_ = 0;  // of its newest message
  int contradictions_ = 0;
  HostTime last_arrival_{}, last_conflict_{};
  std::int64_t conflicts_ = 0, foreign_ = 0;
};

}  // namespace tactus::sync
