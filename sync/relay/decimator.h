// Thins a channel by its rule, and renumbers the remaining messages, so that receivers do not count thinned messages as
// losses. Pure.
//
// Snapshots in pages are decided on as a whole, by the operator chain of a degradation profile (sync/degradation/), in
// simulated time, and by publication time while the world stands still. Other states are decided on by their publication time,
// because the hand moves while the world stands still.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <tactus/header_t.hpp>
#include <vector>

#include "sync/relay/newest_message.h"
#include "sync/relay/rules.h"
#include "sync/time/time.h"

namespace tactus::sync {

class Decimator {
 public:
  using Out = std::function<void(std::span<const std::uint8_t>)>;
  // Senders on a channel; more come only from corrupt messages, and reset all.
  static constexpr std::size_t kMaxSenders = 256;

  explicit Decimator(const PassRule& rule);
  ~Decimator();
  Decimator(Decimator&&) noexcept;

  // Calls out(message) for the messages that pass now: this one or none, or with the last page of a snapshot all its pages.
  void push(const header_t& header, std::span<const std::uint8_t> message, HostTime arrival, const Out& out);

 private:
  // Messages on their way through one site overtake one another by less. Design.
  static constexpr Nanoseconds kPatience{40'000'000};
  // The messages of one sender.
  class Comparison {
   public:
    virtual ~Comparison() = default;
    // Appends the messages that pass now; an invalid message is ignored.
    virtual void push(std::span<const std::uint8_t> message, HostTime arrival,
                      std::vector<std::vector<std::uint8_t>>& out) = 0;
  };
  template <class Message>
  class Compared;
  class Motion;
  struct Sender {
    std::int64_t incarnation = 0;
    std::int64_t next_seq = 0;
    std::int64_t next_ns = 0;  // publish_time_ns of the next that passes
    NewestMessage newest{kPatience};
    std::unique_ptr<Comparison> comparison{};
  };
  std::unique_ptr<Comparison> comparison() const;
  bool due(Sender& sender, const header_t& header, HostTime arrival) const;

  PassRule rule_;
  std::map<std::int32_t, Sender> senders_;  // by header.source
  std::vector<std::vector<std::uint8_t>> passing_;
};

}  // namespace tactus::sync
