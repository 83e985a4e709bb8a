// The motion of a hand over a line: the relay of its site sends a TOOL_STATE only when the motion leaves the deadband of the rule, and
// the relay of the other site publishes the motion between two of them, with the value that the deadband compares held or
// predicted (sync/degradation/motion_codec.h). Both ends count time by header_t.publish_time_ns, so that they predict the same motion.
// A motion ends when its sender has been silent for twice the time of resend=, so that a hand behind a broken line does not move on. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <tactus/tool_state_t.hpp>
#include <utility>
#include <vector>

#include "sync/degradation/deadband.h"
#include "sync/degradation/motion_codec.h"
#include "sync/relay/newest_message.h"
#include "sync/relay/rules.h"
#include "sync/time/time.h"

namespace tactus::sync {

// Longest time of resend=, s: a hand behind a broken line moves on for twice this time. Design.
inline constexpr double kMaxMotionResend_s = 1;

// True for a rule whose motions are sent and published again by this file: a deadband of velocity or position on TOOL_STATE with a
// time of resend.
bool carries_motion(const PassRule& rule);

// The sending end, for one sender. A message with a wrong number or time stops the motion that follows for at most twice the time of resend.
class MotionSender {
 public:
  explicit MotionSender(const DeadbandDef& deadband) : def_(deadband) {}
  // True when this message must be sent: never for a repetition, which the receiver would ignore.
  bool send(const tool_state_t& m, HostTime arrival);

 private:
  static constexpr std::size_t kMaxTools = 64;  // more come only from corrupt messages
  struct Tool {
    Deadband deadband;
    NewestMessage newest;
  };
  DeadbandDef def_;
  std::map<std::int32_t, Tool> tools_;
};

// The receiving end of one line, for all senders.
class MotionReceiver {
 public:
  using Out = std::function<void(std::span<const std::uint8_t>)>;
  static constexpr std::size_t kMaxHands = 64;  // more come only from corrupt messages, and reset all

  explicit MotionReceiver(const DeadbandDef& deadband) : def_(deadband) {}
  // A message of TOOL_STATE from the line. Returns false when it is invalid.
  bool push(std::span<const std::uint8_t> message, HostTime arrival);
  // Calls out(message) for each message that arrived since the last call, and for each other hand whose motion continues, with its
  // motion at `now`. The messages of a hand are numbered without the suppressed ones; messages that the line has lost are gaps.
  void publish(HostTime now, const Out& out);

 private:
  struct Hand {
    explicit Hand(const DeadbandDef& deadband) : numbers(from_seconds(2 * deadband.resend_s)) {}
    NewestMessage numbers;
    tool_state_t newest{};        // as sent
    HostTime arrival{};           // of it
    double sim_per_publish = 1;   // rate of simulated time over publication time, between the two newest messages; at first, of a world that runs
    MotionCodec motion;
    std::int64_t seq = 0;         // of the next published message
  };
  using Key = std::pair<std::int32_t, std::int32_t>;  // source and tool

  std::optional<tool_state_t> motion_at(Hand& hand, HostTime now) const;

  DeadbandDef def_;
  std::map<Key, Hand> hands_;
  std::vector<std::pair<Key, tool_state_t>> arrived_;
};

}  // namespace tactus::sync
