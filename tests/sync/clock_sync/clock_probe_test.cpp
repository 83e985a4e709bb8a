// Tests of clock probes between hosts: offsets, rejected answers and rate of messages.
#include "sync/clock_sync/clock_probe.h"

#include <catch2/catch.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/clock_probe_t.hpp>
#include <vector>

#include "lcmtypes/valid.h"
#include "sync/clock_sync/clock_map_estimator.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

using tactus::test::kMs;
constexpr std::int64_t kAhead = 900'000 * kMs;

Identity host(std::int32_t clock, std::int64_t run = 7) {
  Identity id;
  id.source = 1, id.incarnation = clock + 10, id.run_id = run, id.clock = clock;
  return id;
}

// Fills the header as sync/clock_sync/probe_thread.cpp does.
clock_probe_t sent_by(const Identity& id, clock_probe_t m, HostTime now) {
  m.header = {-1, to_ns(now), id.clock, id.run_id, id.source, id.incarnation, 0};
  return m;
}

struct Pair {
  Identity a = host(1), b = host(2);
  ClockProber prober{a, host_time(0)};
  std::int64_t nonce = 100;

  clock_probe_t ask(HostTime now) { return sent_by(a, *prober.request(now, now, nonce++), now); }
  // The answer of host b, whose clock is kAhead ahead.
  clock_probe_t answer(const clock_probe_t& request, std::int64_t arrived_ns, std::int64_t replied_ns) {
    clock_probe_t m = *probe_reply(request, b, host_time(arrived_ns + kAhead));
    m.reply_sent_ns = replied_ns + kAhead;
    return sent_by(b, m, host_time(replied_ns + kAhead));
  }
  // One wave in which probe i takes there[i] and back[i]; negative: lost.
  std::vector<ProbeWave> wave(const std::vector<std::pair<std::int64_t, std::int64_t>>& ways) {
    for (const auto& [there, back] : ways) {
      const HostTime now = prober.next();
      const clock_probe_t request = ask(now);
      REQUIRE(valid(request));
      if (there < 0) continue;
      const std::int64_t arrived = to_ns(now) + there;
      const clock_probe_t reply = answer(request, arrived, arrived + 1000);
      REQUIRE(valid(reply));
      prober.reply(reply, host_time(arrived + 1000 + back));
    }
    return prober.finish(prober.next());
  }
};

}  // namespace

TEST_CASE("A wave is eight probes at 64 ms every two seconds and keeps the smallest round trip") {
  Pair p;
  const HostTime begin = p.prober.next();
  const auto waves = p.wave({{9000, 9000}, {500, 700}, {9000, 100}, {800, 800}, {-1, 0}, {-1, 0}, {50'000, 2}, {600, 601}});
  REQUIRE(waves.size() == 1);
  CHECK(waves[0].clock == 2);
  CHECK(waves[0].round_trip == Nanoseconds(1200));
  CHECK(waves[0].replies == 6);
  CHECK(waves[0].sample.offset == Nanoseconds(kAhead - 100));
  CHECK(waves[0].sample.at == begin + ClockProber::kSpacing + Nanoseconds(1100));
  SECTION("the first two waves of a new clock are one second apart") {
    CHECK(p.prober.next() == begin + ClockProber::kFirstPeriod);
    const std::vector<std::pair<std::int64_t, std::int64_t>> ways(8, {500, 500});
    p.wave(ways);
    CHECK(p.prober.next() == begin + 2 * ClockProber::kFirstPeriod);
    p.wave(ways);
    CHECK(p.prober.next() == begin + 2 * ClockProber::kFirstPeriod + ClockProber::kPeriod);
    CHECK_FALSE(p.prober.request(p.prober.next() - Nanoseconds(1), begin, 1));
  }
}

TEST_CASE("The wave period grows with the number of clocks, so that total traffic grows linearly with hosts") {
  for (const std::int32_t others : {1, 16, 31, 32, 63}) {
    Pair p;
    Nanoseconds last{0};
    for (int wave = 0; wave < ClockProber::kFirstWaves + 1; ++wave) {
      const HostTime begin = p.prober.next();
      for (int probe = 0; probe < ClockProber::kProbes; ++probe) {
        const HostTime now = p.prober.next();
        const clock_probe_t request = p.ask(now);
        for (std::int32_t k = 0; k < others; ++k) {
          clock_probe_t reply = p.answer(request, to_ns(now) + 500, to_ns(now) + 600);
          reply.header.clock = 100 + k;
          p.prober.reply(reply, now + Nanoseconds(1100));
        }
      }
      REQUIRE(p.prober.finish(p.prober.next()).size() == static_cast<std::size_t>(others));
      last = p.prober.next() - begin;
    }
    INFO(others << " other clocks");
    CHECK(last == ClockProber::kPeriod * std::max(1, others / 16));
    // Requests and answers of all hosts together, per second: each host answers each other host.
    const double hosts = others + 1.0;
    CHECK(8 * hosts * (1 + others) / to_seconds(last) <= 64 * 2 * hosts + 64);
  }
}

TEST_CASE("One reply of eight is enough for a wave, and a wave without replies is skipped") {
  Pair p;
  std::vector<std::pair<std::int64_t, std::int64_t>> ways(8, {-1, 0});
  CHECK(p.wave(ways).empty());
  ways[3] = {400'000, 500'000};
  const auto waves = p.wave(ways);
  REQUIRE(waves.size() == 1);
  CHECK(waves[0].replies == 1);
}

TEST_CASE("Probes keep their spacing after a stall") {
  Pair p;
  p.ask(host_time(0));
  const HostTime late = host_time(5'000 * kMs);
  REQUIRE(p.prober.request(late, late, 1));
  CHECK_FALSE(p.prober.request(late, late, 2));
  CHECK(p.prober.next() == late + ClockProber::kSpacing);
}

TEST_CASE("Only other clocks of the same run answer a request") {
  Pair p;
  const clock_probe_t request = p.ask(host_time(0));
  CHECK(probe_reply(request, host(2), host_time(5)));
  CHECK_FALSE(probe_reply(request, host(1), host_time(5)));
  CHECK_FALSE(probe_reply(request, host(2, 8), host_time(5)));
  CHECK_FALSE(probe_reply(p.answer(request, 10, 20), host(3), host_time(5)));
}

TEST_CASE("A forged reply is rejected and changes nothing") {
  Pair p;
  const clock_probe_t request = p.ask(host_time(0));
  const clock_probe_t good = p.answer(request, 1000, 2000);
  const HostTime back = host_time(3000);
  std::vector<clock_probe_t> hostile;
  const auto altered = [&](auto change) {
    clock_probe_t m = good;
    change(m);
    hostile.push_back(m);
  };
  altered([](auto& m) { ++m.nonce; });
  altered([](auto& m) { m.request_sent_ns -= 10 * kMs; });
  altered([](auto& m) { m.reply_sent_ns += 5000; });                       // longer at the other host than the whole round trip
  altered([](auto& m) { m.reply_sent_ns = m.request_arrived_ns - 1; });    // answered before the request arrived
  altered([](auto& m) { m.header.run_id = 8; });
  altered([](auto& m) { m.header.clock = 1; });                            // with the receiver's own clock id
  altered([](auto& m) { m.kind = clock_probe_t::REQUEST; });
  for (const clock_probe_t& m : hostile) p.prober.reply(m, back);
  p.prober.reply(good, host_time(200 * kMs));                              // too late for this request
  for (int i = 1; i < ClockProber::kProbes; ++i) p.ask(p.prober.next());
  CHECK(p.prober.finish(p.prober.next()).empty());

  SECTION("replies of more clocks than the maximum are rejected, also in floods") {
    const HostTime now = p.prober.next();
    const clock_probe_t asked = p.ask(now);
    for (int clock = 2; clock < 1000; ++clock) {
      clock_probe_t m = p.answer(asked, to_ns(now) + 10, to_ns(now) + 20);
      m.header.clock = clock;
      for (int i = 0; i < 50; ++i) p.prober.reply(m, now + Nanoseconds(40));
    }
    while (p.prober.next() < now + 8 * ClockProber::kSpacing - Nanoseconds(kMs)) p.ask(p.prober.next());
    CHECK(p.prober.finish(p.prober.next()).size() == ClockProber::kMaxClocks);
  }
}

TEST_CASE("A wave with contradictory replies is dropped") {
  Pair p;
  for (int i = 0; i < ClockProber::kProbes; ++i) {
    const HostTime now = p.prober.next();
    clock_probe_t reply = p.answer(p.ask(now), to_ns(now) + 1000, to_ns(now) + 2000);
    if (i >= 4) reply.request_arrived_ns += 500 * kMs, reply.reply_sent_ns += 500 * kMs;
    p.prober.reply(reply, now + Nanoseconds(3000));
  }
  CHECK(p.prober.finish(p.prober.next()).empty());
}

TEST_CASE("Every other clock has a valid map until it has been silent for 30 s") {
  ClockMapEstimator map_estimator(1);
  const auto heard = [&](std::int32_t clock, std::int64_t ms, std::int64_t offset) {
    return map_estimator.add({clock, {host_time(ms * kMs), Nanoseconds(offset), Nanoseconds(50'000)}, Nanoseconds(90'000), 8});
  };
  heard(2, 1000, kAhead);
  heard(3, 1000, -5);
  heard(2, 3000, kAhead + 10);
  auto maps = map_estimator.maps(host_time(3500 * kMs));
  REQUIRE(maps.size() == 2);
  for (clock_map_t& m : maps) {
    m.header = {-1, 5, 1, 7, 1, 1, 0};
    CHECK(valid(m));
    CHECK(m.to_clock == 1);
    CHECK(m.replies == 8);
  }
  CHECK(heard(2, 5000, kAhead + 900 * kMs) == OffsetTracker::Outcome::kJumped);
  CHECK(map_estimator.maps(host_time(32'000 * kMs)).size() == 1);
  CHECK(map_estimator.maps(host_time(36'000 * kMs)).empty());
}
