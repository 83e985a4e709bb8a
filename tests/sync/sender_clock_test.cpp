#include "sync/sender_clock.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus::sync;

namespace {

constexpr double kSecond = 1e9;

// A sender whose clock is `offset` ahead and gains `drift` seconds a second.
struct Sender {
  double offset_ns, drift;
  std::int64_t stamp(double host_ns) const {
    return static_cast<std::int64_t>(host_ns + offset_ns + drift * host_ns);
  }
};

}  // namespace

TEST_CASE("The bias is never negative and at most the smallest latency plus the drift since") {
  std::mt19937 random(1);
  for (const double drift : {-200e-6, -50e-6, 0.0, 50e-6, 200e-6}) {
    for (const double offset_s : {-5000.0, 0.5, 90000.0}) {
      const Sender sender{offset_s * kSecond, drift};
      std::exponential_distribution<double> latency_ns(1 / 3e6);
      SenderClock clock;
      std::vector<std::pair<double, double>> heard;  // when, latency
      double now = 10 * kSecond;
      for (int i = 0; i < 3000; ++i) {
        now += 20e6;
        const double latency = 50e3 + latency_ns(random);
        heard.emplace_back(now, latency);
        REQUIRE_FALSE(
            clock.observe(sender.stamp(now - latency), host_time(static_cast<std::int64_t>(now)), false));
        const double bias = static_cast<double>(to_ns(
                                clock.to_host(sender.stamp(now), host_time(static_cast<std::int64_t>(now))))) -
                            now;
        double bound = 1e18;
        for (const auto& [when, l] : heard)
          bound = std::min(bound, l + 2 * SenderClock::kMaxDrift * (now - when + l));
        INFO("drift " << drift << ", step " << i);
        // Each of the two conversions rounds by a nanosecond.
        REQUIRE(bias >= -2);
        REQUIRE(bias <= bound + 2);
      }
    }
  }
}

TEST_CASE("A sender of our own run and host has our own clock") {
  SenderClock clock;
  CHECK_FALSE(clock.known());
  CHECK_FALSE(clock.observe(1000, host_time(999'999), true));
  CHECK(clock.known());
  CHECK(clock.to_host(1234, host_time(5'000'000)) == host_time(1234));
}

TEST_CASE("An unknown clock maps to itself") { CHECK(SenderClock().to_host(77, host_time(5)) == host_time(77)); }

TEST_CASE("A clock that jumps is noticed and learned anew at once") {
  SenderClock clock;
  const auto now = [](double s) { return host_time(static_cast<std::int64_t>(s * kSecond)); };
  clock.observe(5 * 1'000'000'000LL, now(100), false);
  for (const double jump_s : {+3600.0, -3600.0, +2.5, -2.5}) {
    SenderClock c = clock;
    const auto stamp = static_cast<std::int64_t>((6 + jump_s) * kSecond);
    CHECK(c.observe(stamp, now(101), false));
    CHECK(c.to_host(stamp, now(101)) == now(101));
  }
  SECTION("but a delay of less than two seconds is none") {
    CHECK_FALSE(clock.observe(5 * 1'000'000'000LL, now(101.9), false));
    CHECK(clock.to_host(5 * 1'000'000'000LL, now(101.9)) - now(100) < Nanoseconds(1'000'000));
  }
}
