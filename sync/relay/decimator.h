// Leaves out of a channel what its rule does not let pass, and numbers the rest anew, so that what was left out is
// no loss to who hears it. Pure.
//
// Snapshots in pages are decided on as a whole, by the stack of a degradation profile (sync/degradation/): by
// simulated time. Other states by the time of their sending, for the hand moves while the world stands still.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <tactus/header_t.hpp>
#include <vector>

#include "sync/relay/rules.h"
#include "sync/time/time.h"

namespace tactus::sync {

class Decimator {
 public:
  using Out = std::function<void(std::span<const std::uint8_t>)>;
  // Senders on a channel; more are of false messages, and all begin anew.
  static constexpr std::size_t kMaxSenders = 256;

  explicit Decimator(const PassRule& rule);
  ~Decimator();
  Decimator(Decimator&&) noexcept;

  // Calls out(message) for what may pass now: this one or none, or with the last page of a snapshot all of them.
  void take(const header_t& header, std::span<const std::uint8_t> message, HostTime arrival, const Out& out);
  std::int64_t left_out() const { return left_out_; }
  // Were no valid message of the channel.
  std::int64_t bad() const { return bad_; }

 private:
  // One sender's messages.
  class Comparison {
   public:
    virtual ~Comparison() = default;
    virtual bool take(std::span<const std::uint8_t> message, HostTime arrival,
                      std::vector<std::vector<std::uint8_t>>& out) = 0;
  };
  template <class Message>
  class Compared;
  struct Sender {
    std::int64_t incarnation = 0;
    std::int64_t next_seq = 0;
    std::int64_t next_ns = 0, newest_ns = 0;  // publish_time_ns of the next that passes; of the newest
    std::unique_ptr<Comparison> comparison{};
  };
  std::unique_ptr<Comparison> comparison() const;
  bool due(Sender& sender, const header_t& header) const;

  PassRule rule_;
  std::map<std::int32_t, Sender> senders_;  // by header.source
  std::vector<std::vector<std::uint8_t>> passing_;
  std::int64_t left_out_ = 0, bad_ = 0;
};

}  // namespace tactus::sync
