// Two-way probes between hosts: who is asked when, what is answered, which answer counts. Pure.
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

// The answer of `own` to a request that arrived at `arrived`; the sender fills reply_sent_ns and the header's numbering.
// Nothing for what is no request, of another run, or of our own clock.
std::optional<clock_probe_t> probe_answer(const clock_probe_t& request, const Identity& own, HostTime arrived);

// What one wave of probes says of one clock.
struct ProbeWave {
  std::int32_t clock = 0;
  OffsetSample sample;  // of the smallest round trip
  Nanoseconds round_trip{0};
  std::int32_t replies = 0;
};

// Asks in waves and keeps of each clock the answer with the smallest round trip.
class ClockProber {
 public:
  // As the Lab Streaming Layer does it (liblsl, api_config.cpp: TimeProbeCount 8, TimeProbeInterval 64 ms,
  // TimeUpdateInterval 2 s); its limit of 128 ms for a round trip, rounded up to the next probes.
  static constexpr int kProbes = 8;
  static constexpr Nanoseconds kSpacing{64'000'000};
  static constexpr Nanoseconds kPeriod{2'000'000'000};
  // A clock that is new is asked again sooner, so that its rate is known after two seconds, not four (design).
  static constexpr int kFirstWaves = 3;
  static constexpr Nanoseconds kFirstPeriod{1'000'000'000};
  static constexpr Nanoseconds kLongestTrip{128'000'000};
  // Of more clocks than these each is asked less often in proportion, so that the probes of a network grow with its hosts
  // and not with their square: of 64 every 8 s, in which the 15 ppm that a measured rate leaves open (RFC 5905, PHI)
  // are 120 us.
  static constexpr std::size_t kFewClocks = 16;
  // Design: more hosts than a cluster has; what answers beyond that is counted as refused.
  static constexpr std::size_t kMaxClocks = 64;

  ClockProber(Identity own, HostTime first_wave) : own_(std::move(own)), wave_begin_(first_wave) {}

  // When request() or finish() has something to do.
  HostTime next() const;
  // The request that is due, if one is. It leaves now, which is `stamp` on the clock that is compared; `nonce` is random.
  std::optional<clock_probe_t> request(HostTime now, HostTime stamp, std::int64_t nonce);
  // back: on the clock that is compared.
  void reply(const clock_probe_t& reply, HostTime back);
  // After the last answer of a wave could have come: what it says. Then the next wave begins.
  std::vector<ProbeWave> finish(HostTime now);

  // Answers that nobody asked for, too late, impossible, or one too many.
  std::int64_t refused() const { return refused_; }
  // Waves of a clock whose answers contradicted each other: it jumped meanwhile, or somebody lies.
  std::int64_t contradictory() const { return contradictory_; }

 private:
  struct Sent {
    std::int64_t nonce, sent_ns;
  };
  struct Heard {
    ProbeWave wave;
    Nanoseconds least, most;  // what all answers of the wave allow the offset to be
  };
  bool takes(const clock_probe_t& reply, HostTime back) const;

  Identity own_;
  HostTime wave_begin_;
  std::vector<Sent> sent_;  // of this wave
  std::map<std::int32_t, Heard> heard_;
  std::map<std::int32_t, int> waves_;  // heard of each clock, up to kFirstWaves
  std::int64_t refused_ = 0, contradictory_ = 0;
};

}  // namespace tactus::sync
