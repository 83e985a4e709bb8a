// Tests of estimating a clock offset from arrivals only.
#include "sync/clocks/one_way_offset_estimator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus::sync;

namespace {

constexpr double kSecond_ns = 1e9;

// A sender whose clock is `offset` ahead and gains `drift` seconds per second.
struct RemoteClock {
  double offset_ns, drift;
  std::int64_t stamp(double host_ns) const {
    return static_cast<std::int64_t>(host_ns + offset_ns + drift * host_ns);
  }
};

}  // namespace

TEST_CASE("The bias is not negative and at most the smallest latency plus the drift since then") {
  std::mt19937 random(1);
  for (const double drift : {-200e-6, -50e-6, 0.0, 50e-6, 200e-6}) {
    for (const double offset_s : {-5000.0, 0.5, 90000.0}) {
      const RemoteClock sender{offset_s * kSecond_ns, drift};
      std::exponential_distribution<double> latency_ns(1 / 3e6);
      OneWayOffsetEstimator clock;
      std::vector<std::pair<double, double>> heard;  // arrival, latency
      double now = 10 * kSecond_ns;
      for (int i = 0; i < 3000; ++i) {
        now += 20e6;
        const double latency = 50e3 + latency_ns(random);
        heard.emplace_back(now, latency);
        REQUIRE_FALSE(
            clock.observe(sender.stamp(now - latency), host_time(static_cast<std::int64_t>(now))));
        const double bias = static_cast<double>(to_ns(
                                clock.to_host(sender.stamp(now), host_time(static_cast<std::int64_t>(now))))) -
                            now;
        double bound = 1e18;
        for (const auto& [when, l] : heard)
          bound = std::min(bound, l + 2 * OneWayOffsetEstimator::kMaxDrift * (now - when + l));
        INFO("drift " << drift << ", step " << i);
        // Each of the two conversions rounds by up to 1 ns.
        REQUIRE(bias >= -2);
        REQUIRE(bias <= bound + 2);
      }
    }
  }
}

TEST_CASE("An unknown clock maps to itself") { CHECK(OneWayOffsetEstimator().to_host(77, host_time(5)) == host_time(77)); }

TEST_CASE("A clock jump is detected and the offset is estimated again at once") {
  OneWayOffsetEstimator clock;
  const auto now = [](double s) { return host_time(static_cast<std::int64_t>(s * kSecond_ns)); };
  clock.observe(5 * 1'000'000'000LL, now(100));
  for (const double jump_s : {+3600.0, -3600.0, +2.5, -2.5}) {
    OneWayOffsetEstimator c = clock;
    const auto stamp = static_cast<std::int64_t>((6 + jump_s) * kSecond_ns);
    CHECK(c.observe(stamp, now(101)));
    CHECK(c.to_host(stamp, now(101)) == now(101));
  }
  SECTION("a delay of less than two seconds is not a jump") {
    CHECK_FALSE(clock.observe(5 * 1'000'000'000LL, now(101.9)));
    CHECK(clock.to_host(5 * 1'000'000'000LL, now(101.9)) - now(100) < Nanoseconds(1'000'000));
  }
}

TEST_CASE("A clock step back of less than two seconds is detected in the window or relaxed within 31 s") {
  std::mt19937 random(2);
  for (const double back_ms : {1.0, 4.0, 6.0, 20.0, 300.0, 1900.0}) {
    for (const double rate_Hz : {10.0, 1000.0}) {
      OneWayOffsetEstimator clock;
      std::exponential_distribution<double> latency_ns(1 / 0.5e6);
      double now = 0, noticed_s = -1;
      const double jump_at = 20 * kSecond_ns;
      while (now < 60 * kSecond_ns) {
        now += kSecond_ns / rate_Hz;
        const double offset = 7 * kSecond_ns - (now >= jump_at ? back_ms * 1e6 : 0);
        const double latency = 100e3 + latency_ns(random);
        clock.observe(static_cast<std::int64_t>(now - latency + offset), host_time(static_cast<std::int64_t>(now)));
        const double error = static_cast<double>(to_ns(clock.to_host(static_cast<std::int64_t>(now + offset),
                                                                     host_time(static_cast<std::int64_t>(now))))) - now;
        // Before and after the jump, the estimate is late by a latency. In between, it is early by the size of the jump.
        if (now >= jump_at && noticed_s < 0 && error > -0.2e6) noticed_s = (now - jump_at) / kSecond_ns;
      }
      INFO(back_ms << " ms back at " << rate_Hz << " Hz");
      CHECK(noticed_s >= 0);
      CHECK(noticed_s <= (back_ms > 6 ? 2.6 : 31));
    }
  }
}

TEST_CASE("High network latency is not a jump while some messages are quick") {
  OneWayOffsetEstimator clock;
  for (int i = 0; i < 600; ++i) {
    const std::int64_t now = (i + 1) * 100'000'000LL;
    const std::int64_t latency = i < 10 || i % 15 == 0 ? 200'000 : 40'000'000;
    REQUIRE_FALSE(clock.observe(now - latency, host_time(now)));
  }
  CHECK(clock.to_host(60'000'000'000, host_time(60'000'000'000)) - host_time(60'000'000'000) < Nanoseconds(1'000'000));
}
