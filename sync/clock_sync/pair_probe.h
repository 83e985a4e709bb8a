// Measurements between hosts before a cluster runs: reachability, losses, round trips and clock offsets. Every host sends
// numbered datagrams to the group, and answers those of the others. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

// One datagram. Times are of the sender's monotonic clock, ns.
struct PairDatagram {
  enum Kind : std::uint8_t { kRequest = 1, kReply = 2, kBurst = 3, kEnd = 4 };
  static constexpr std::size_t kMaxName = 40;
  static constexpr std::size_t kMinBytes = 4 + 8 + 1 + 8 + 2 * (kMaxName + 1) + 3 * 8;
  static constexpr std::size_t kMaxBytes = 1400;

  std::uint64_t run = 0;  // id of this round of probes; others are ignored
  Kind kind = kRequest;
  std::uint64_t number = 0;  // from 0 for each kind; kEnd: the number of requests
  std::string from, to;      // to: of an answer
  std::int64_t sent_ns = 0, received_ns = 0, replied_ns = 0;

  // Padded with zeros to `size` bytes.
  std::vector<std::uint8_t> encode(std::size_t size) const;
  // nullopt when the bytes are not such a datagram.
  static std::optional<PairDatagram> decode(std::span<const std::uint8_t> data);
};

// The messages that one host has received from another.
class PairRecord {
 public:
  void on_message(const PairDatagram& m, int ttl);
  // An answer to our request, which arrived at `at`.
  void on_reply(const PairDatagram& m, HostTime at);

  bool received() const { return !requests_.empty(); }
  bool replied() const { return !round_trips_.empty(); }
  // Share of the other host's numbered datagrams that did not arrive, by their highest number or by its kEnd.
  double lost() const;
  // Number of received datagrams of bursts.
  std::size_t burst_datagrams() const { return bursts_.size(); }
  int ttl() const { return ttl_; }                                        // on arrival; -1: unknown
  Nanoseconds round_trip(double share) const;                             // a quantile
  Nanoseconds offset() const { return offset_; }                          // of the other's clock to ours
  Nanoseconds uncertainty() const { return min_round_trip_ / 2 + Nanoseconds(1); }  // half the least round trip

 private:
  std::set<std::uint64_t> requests_, bursts_;
  std::uint64_t sent_ = 0;
  int ttl_ = -1;
  std::vector<Nanoseconds> round_trips_;
  Nanoseconds offset_{0}, min_round_trip_ = Nanoseconds::max() / 4;
};

}  // namespace tactus::sync
