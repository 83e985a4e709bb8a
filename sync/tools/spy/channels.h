// Statistics of all messages on a bus, by channel: volume, regularity, losses, age, and the newest message. Pure; bounded for
// any number of channels and senders.
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
  std::string type;  // of the newest message; empty: not a type of this system
  std::int64_t messages = 0, gaps = 0;
  std::int64_t torn = 0;  // fragments, or no whole message of their type
  double rate_Hz = 0, bytes_per_s = 0;
  Arrivals::Jitter jitter;  // jitter of the sender with the largest jitter
  int senders = 0;
  // From publication to arrival, of the newest message, ms, and its uncertainty; negative: unknown. On a clock without a map:
  // beyond the smallest observed.
  double age_ms = -1, age_uncertainty_ms = -1;
  double silent_s = 0;  // since the newest message
};

class Channels {
 public:
  static constexpr std::size_t kMax = 512;
  static constexpr std::size_t kMaxSenders = 16;  // of a channel

  explicit Channels(OwnClock own) : own_(own) {}

  void push(const MessageBatch::Message& message);
  // The figures of all channels, ordered by name.
  std::vector<ChannelFigures> figures(HostTime now) const;
  // The bytes of the newest message on a channel; empty: there is none.
  std::span<const std::uint8_t> newest(std::string_view channel) const;
  // Messages on channels beyond kMax.
  std::int64_t beyond() const { return beyond_; }
  std::int64_t messages() const { return messages_; }

 private:
  struct Sender {
    explicit Sender(OwnClock own) : clock(own) {}
    Arrivals arrivals;
    SenderClock clock;
  };
  struct Channel {
    std::map<std::int32_t, Sender> senders;  // by source; 0: messages without a header of this system
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
