// Two-way clock probes between hosts: the schedule of requests, the answers, and the selection of the best answer. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tactus/clock_probe_t.hpp>
#include <vector>

#include "sync/bus/identity.h"
#include "sync/clock_sync/offset_tracker.h"
#include "sync/time/time.h"

namespace tactus::sync {

// The answer of `own` to a request that arrived at `arrived`; the sender sets reply_sent_ns and the header's numbering.
// nullopt for a message that is not a request, is of another run, or is of our own clock.
std::optional<clock_probe_t> probe_reply(const clock_probe_t& request, const Identity& own, HostTime arrived);

// The result of one wave of probes for one clock.
struct ProbeWave {
  std::int32_t clock = 0;
  OffsetSample sample;  // of the smallest round trip
  Nanoseconds round_trip{0};
  std::int32_t replies = 0;
};

// Sends requests in waves, and keeps for each clock the answer with the smallest round trip.
class ClockProber {
 public:
  // Values of the Lab Streaming Layer (liblsl, api_config.cpp: TimeProbeCount 8, TimeProbeInterval 64 ms,
  // TimeUpdateInterval 2 s); its limit of 128 ms for a round trip, rounded up to the next probes.
  static constexpr int kProbes = 8;
  static constexpr Nanoseconds kSpacing{64'000'000};
  static constexpr Nanoseconds kPeriod{2'000'000'000};
  // A new clock is probed again sooner, so that its rate is known after two seconds instead of four (design).
  static constexpr int kFirstWaves = 3;
  static constexpr Nanoseconds kFirstPeriod{1'000'000'000};
  static constexpr Nanoseconds kMaxRoundTrip{128'000'000};
  // With more clocks than this, each is probed less often in proportion, so that the probes of a network grow with the number
  // of hosts and not with its square. 64 clocks are probed every 8 s, in which the 15 ppm uncertainty of a measured rate (RFC
  // 5905, PHI) amounts to 120 us.
  static constexpr std::size_t kFewClocks = 16;
  // Design: more hosts than a cluster has; further answers are refused.
  static constexpr std::size_t kMaxClocks = 64;

  ClockProber(Identity own, HostTime first_wave) : own_(std::move(own)), wave_begin_(first_wave) {}

  // The next time at which request() or finish() has work to do.
  HostTime next() const;
  // The due request, if any. It is sent now, which is `stamp` on the clock that is compared; `nonce` is random.
  std::optional<clock_probe_t> request(HostTime now, HostTime stamp, std::int64_t nonce);
  // back: on the clock that is compared.
  void reply(const clock_probe_t& reply, HostTime returned);
  // Returns the results of a wave after its last possible answer, and starts the next wave.
  std::vector<ProbeWave> finish(HostTime now);

 private:
  struct Sent {
    std::int64_t nonce, sent_ns;
  };
  struct ClockReplies {
    ProbeWave wave;
    Nanoseconds min_offset, max_offset;  // range of the offset that all answers of the wave allow
  };
  bool accepts(const clock_probe_t& reply, HostTime returned) const;

  Identity own_;
  HostTime wave_begin_;
  std::vector<Sent> sent_;  // of this wave
  std::map<std::int32_t, ClockReplies> replies_;
  std::map<std::int32_t, int> waves_;  // received of each clock, up to kFirstWaves
};

}  // namespace tactus::sync
