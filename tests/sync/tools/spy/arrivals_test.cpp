// Tests of rate, bandwidth and jitter of a sender, against closed forms.
#include "sync/tools/spy/arrivals.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::sync;
using namespace tactus::sync::spy;

namespace {
HostTime at_us(std::int64_t us) { return host_time(us * 1000); }
}  // namespace

TEST_CASE("Even arrivals have the exact rate and bandwidth and no jitter") {
  const double rate = GENERATE(0.9, 10.0, 60.0, 1000.0, 5000.0);
  Arrivals a;
  std::int64_t last = 0;
  const auto period_us = static_cast<std::int64_t>(1e6 / rate);
  for (last = 0; last < 4'000'000; last += period_us) a.add(at_us(last), 250);
  const HostTime now = at_us(last - period_us);
  CHECK(a.rate_Hz(now) == Approx(1e6 / static_cast<double>(period_us)));
  CHECK(a.bytes_per_s(now) == Approx(250e6 / static_cast<double>(period_us)));
  CHECK(a.jitter(now).p99_ms == Approx(0).margin(1e-9));
}

TEST_CASE("The rate falls to zero within two seconds after the last message") {
  Arrivals a;
  for (int i = 0; i <= 2000; ++i) a.add(at_us(1000 * i), 100);
  CHECK(a.rate_Hz(at_us(2'000'000)) == Approx(1000));
  const double after_1s = a.rate_Hz(at_us(3'000'000));
  CHECK(after_1s == Approx(500).epsilon(0.01));  // a thousand within the last two seconds
  CHECK(a.rate_Hz(at_us(4'001'000)) == 0);
  CHECK(a.bytes_per_s(at_us(4'001'000)) == 0);
}

TEST_CASE("Jitter is the deviation of the message interval from its median") {
  // Each arrival is moved by a uniform deviation of +-w. The difference of two is triangular within +-2w; its absolute value has its
  // median at 2w (1 - sqrt(1/2)) and its 99th percentile at 2w (1 - sqrt(1/100)).
  const double w_ms = 2;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moved(-w_ms, w_ms);
  Arrivals a;
  for (int i = 0; i < 200; ++i)
    a.add(at_us(static_cast<std::int64_t>(1000 * (10.0 * i + moved(random)) + 10000)), 1);
  const Arrivals::Jitter j = a.jitter(at_us(2'000'000));
  CHECK(j.p50_ms == Approx(2 * w_ms * (1 - std::sqrt(0.5))).epsilon(0.25));
  CHECK(j.p99_ms == Approx(2 * w_ms * 0.9).epsilon(0.1));
}

TEST_CASE("Memory is bounded at high rates, and the rate is that of the newest messages") {
  Arrivals a;
  for (int i = 0; i < 1'000'000; ++i) a.add(at_us(i), 100);
  CHECK(a.rate_Hz(at_us(999'999)) == Approx(1e6));
}
