// The time of each event of a run, although the clock of its recorder jumps. Pure.
//
// LCM's logger stamps its events with the date of the machine, which can be set forward or back while it records. The messages
// of this system hold the time at which they were sent, on a clock that is never set. A step of the stamps that the times of
// sending do not show, of all senders, is a jump of the recorder's clock, and is taken out of all later stamps. A single stamp
// that contradicts its neighbours is damaged: its event keeps the time of the previous one. An event that was written later
// than its stamp says, but agrees with its sender, has its place before.
//
// A message can be damaged or forged, with any time of sending. No single message sets or changes what is known about a sender:
// its offset is the third smallest of several messages, and is not known before kMinLearned of them. Two false messages among
// eight change nothing. Messages whose time of sending cannot be true are counted.
//
// In a log without messages of this system only a step back is known to be a jump; the log continues there without a gap.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "sync/log/log_reader.h"

namespace tactus::sync {

// A stamp, and the time of sending where the message has one.
struct StampSample {
  std::int64_t stamp_us = 0;
  bool has_sender = false;
  std::uint64_t sender = 0;  // of its source and incarnation
  std::int64_t publish_us = 0;
};
StampSample stamp_sample(const LogEvent& event);

class RecorderClock {
 public:
  // A smaller step of the recorder's clock is not distinguished from latency. Design: the slack of a loaded machine.
  static constexpr std::int64_t kMinJump_us = 20'000;
  // A longer pause of all messages is examined. Every node publishes its health at 10 Hz.
  static constexpr std::int64_t kPause_us = 100'000;
  // A longer step is accepted only when other events confirm it.
  static constexpr std::int64_t kMaxStep_us = 60'000'000;
  // Confirming messages of a jump, and of a jump by more than kMaxStep_us. Design: fewer than 32 nearby stamps cannot be a run.
  static constexpr std::int64_t kMinVotes = 8, kMinRunEvents = 32;
  // The clocks of two machines drift apart by at most this (as OneWayOffsetEstimator).
  static constexpr double kMaxDrift = 200e-6;
  // Messages of a sender that set its offset, and its newest messages that are stored. Design.
  static constexpr std::size_t kMinLearned = 5, kRecent = 8;

  enum class Order : std::uint8_t { kInOrder, kLate, kMisdated };
  struct Result {
    Order order;
    std::int64_t us;  // the corrected stamp; of a misdated event the time of the previous one
    std::int64_t jump_us = 0;  // of the recorder's clock at this event; 0: none
  };

  // following: a scanner behind the event.
  Result observe(const StampSample& sample, const LogScanner& following);
  // How much later the message was stamped than its sender's usual latency allows; nullopt: the sender is unknown.
  std::optional<std::int64_t> excess_us(const StampSample& sample) const;
  // Correction of the present stamps.
  std::int64_t shift_us() const { return shift_us_; }
  // Number of messages whose time of sending contradicts the other messages of their sender: it lies after the arrival, or more
  // than kMaxStep_us before it.
  std::int64_t contradicting() const { return contradicting_; }

 private:
  static constexpr std::size_t kMaxSenders = 256;
  // The newest differences of corrected stamp and time of sending.
  struct Recent {
    std::array<std::int64_t, kRecent> us{};
    std::size_t count = 0;
    void add(std::int64_t offset_us) { us[count++ % kRecent] = offset_us; }
    // The third smallest: of eight messages nearly the smallest, and of five the median. Precondition: three or more.
    std::int64_t floor_us() const;
  };
  struct Sender {
    std::int64_t offset_us = 0;  // smallest difference that several messages confirm
    std::int64_t publish_us = 0;
    Recent agreeing, contradicting;
    std::int64_t contradicted_since_us = 0, implausible = 0;
    bool known() const { return agreeing.count >= kMinLearned; }
  };
  struct Votes {
    std::int64_t jump_us = 0;
    std::int64_t messages = 0;   // with a known sender
    std::int64_t confirming = 0;  // events with a stamp near the examined one
  };

  Result start(const StampSample& sample, const LogScanner& following);
  Result examine(const StampSample& sample, std::int64_t us, const LogScanner& following);
  bool is_single(std::int64_t us, const LogScanner& following) const;
  Votes votes(const StampSample& sample, const LogScanner& following);
  Result accept(const StampSample& sample, std::int64_t us, std::int64_t jump_us = 0);
  Result misdated() const { return {Order::kMisdated, newest_us_, 0}; }
  void learn(const StampSample& sample, std::int64_t us);
  void contradict(Sender& sender, const StampSample& sample, std::int64_t us, std::int64_t relaxed_us);
  static bool implausible(std::int64_t offset_us, std::int64_t usual_us);

  bool started_ = false;
  std::int64_t newest_us_ = 0, shift_us_ = 0, contradicting_ = 0;
  std::int64_t budget_ = 200'000;  // of events read ahead, so that a log of random stamps is read in linear time
  std::unordered_map<std::uint64_t, Sender> senders_;
};

}  // namespace tactus::sync
