// Everything that is heard on a bus, channel by channel: how much, how regularly, what is missing, how old, and
// the newest message. Pure; bounded however many channels and senders come.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/fields.h"
#include "sync/bus/message_batch.h"
#include "sync/clocks/sender_clock.h"
#include "sync/bus/sequence.h"
#include "sync/tools/spy/arrivals.h"

namespace tactus::sync::spy {

struct ChannelFigures {
  std::string name;
  std::string type;  // of the newest message; empty: of a type that is not ours
  std::int64_t messages = 0, gaps = 0;
  std::int64_t torn = 0;  // of which pieces were missing, or that are no whole message of their type
  double rate_Hz = 0, bytes_per_s = 0;
  Arrivals::Jitter jitter;  // of the sender that is worst
  int senders = 0;
  // From sending to arrival, of the newest message, ms, and its uncertainty; negative: not known. Of a clock that
  // nobody has mapped: beyond the smallest that was seen.
  double age_ms = -1, age_uncertainty_ms = -1;
  double silent_s = 0;  // since the newest arrived
};

class Channels {
 public:
  static constexpr std::size_t kMax = 512;
  static constexpr std::size_t kMaxSenders = 16;  // of a channel

  explicit Channels(OwnClock own) : own_(own) {}

  void push(const MessageBatch::Message& message);
  // By name.
  std::vector<ChannelFigures> figures(HostTime now) const;
  // The bytes of the newest message on a channel; empty: there is none.
  std::span<const std::uint8_t> newest(std::string_view channel) const;
  // Messages on channels beyond kMost.
  std::int64_t beyond() const { return beyond_; }
  std::int64_t messages() const { return messages_; }

 private:
  struct Sender {
    explicit Sender(OwnClock own) : clock(own) {}
    Arrivals arrivals;
    SenderClock clock;
  };
  struct Channel {
    std::map<std::int32_t, Sender> senders;  // by source; 0: whoever has no header of ours
    SequenceTracker sequence;
    std::int64_t messages = 0, torn = 0;
    const MessageType* type = nullptr;
    double age_ms = -1, age_uncertainty_ms = -1;
    HostTime newest{};
    std::vector<std::uint8_t> bytes;
  };
  Sender* sender_of(Channel& channel, std::int32_t source) const;

  OwnClock own_;
  std::map<std::string, Channel, std::less<>> channels_;
  std::int64_t messages_ = 0, beyond_ = 0;
};

}  // namespace tactus::sync::spy
