// Tests of the Weber deadband.
#include "sync/degradation/deadband.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::sync;

namespace {

SimTime ms(int i) { return sim_time(std::int64_t{i} * 1'000'000); }

// A stroke back and forth, 1 kHz: speed up to 0.2 m/s.
Eigen::Vector3d stroke(int i) { return {0.2 * std::sin(2 * M_PI * i / 1000.0), 0, 0}; }

double sent_share(const DeadbandDef& def, double speed_m_s = 0) {
  Deadband deadband(def);
  int sent = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Signal s{1, Quantity::kVelocity, stroke(i)};
    sent += deadband.send(ms(i), {&s, 1}, speed_m_s);
  }
  return sent / 10'000.0;
}

}  // namespace

TEST_CASE("An unsent value differs from the last sent one by at most the deadband") {
  std::mt19937 random(2);
  std::normal_distribution<double> step(0, 0.01);
  for (const double k : {0.02, 0.1, 0.3}) {
    Deadband deadband({.fraction = k, .quantity = Quantity::kForce, .floor = 0.005});
    Eigen::Vector3d x(1, 0, 0), sent = x;
    int n = 0;
    for (int i = 0; i < 5000; ++i) {
      for (int c = 0; c < 3; ++c) x[c] += step(random);
      const Signal s{9, Quantity::kForce, x};
      if (deadband.send(ms(i), {&s, 1}, 0)) {
        if (i > 0) CHECK((x - sent).norm() > std::max(k * sent.norm(), 0.005));
        sent = x;
        ++n;
      }
      CHECK((x - sent).norm() <= std::max(k * sent.norm(), 0.005) + 1e-12);
    }
    CHECK(n > 1);
    CHECK(n < 5000);
  }
}

TEST_CASE("A wider deadband sends fewer messages, and 10 % saves more than 80 % of a stroke") {
  // A sine of amplitude A crosses levels a factor 1.1 apart, or the floor: 4 ln(A/floor)/ln(1.1) crossings per period.
  const DeadbandDef tenth{.fraction = 0.1, .quantity = Quantity::kVelocity, .floor = 0.002};
  const double levels = 4 * (std::log(0.2 / 0.02) / std::log(1.1) + 10);
  CHECK(sent_share(tenth) == Approx(levels / 1000).epsilon(0.5));
  CHECK(sent_share(tenth) < 0.2);
  double before = 1;
  for (const double k : {0.0, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    const double share = sent_share({.fraction = k, .quantity = Quantity::kVelocity, .floor = 0.0005});
    CHECK(share <= before);
    before = share;
  }
}

TEST_CASE("The adaptive deadband widens with speed") {
  const DeadbandDef fixed{.fraction = 0.05, .quantity = Quantity::kVelocity, .floor = 0.001};
  DeadbandDef adaptive = fixed;
  adaptive.adaptive_s_m = 0.5;
  CHECK(sent_share(adaptive, 0) == sent_share(fixed, 0));
  CHECK(sent_share(adaptive, 0.4) < sent_share(fixed, 0.4));
  DeadbandDef wide = fixed;
  wide.fraction = 0.25;
  CHECK(sent_share(adaptive, 0.4) == sent_share(wide));
}

TEST_CASE("A contact that begins or ends is always sent") {
  Deadband deadband({.fraction = 10, .quantity = Quantity::kForce, .floor = 1e9});
  const Signal a{1, Quantity::kForce, {1, 0, 0}}, b{2, Quantity::kForce, {0, 0, 0}};
  const Signal both[] = {a, b};
  CHECK(deadband.send(ms(0), {&a, 1}, 0));
  CHECK_FALSE(deadband.send(ms(1), {&a, 1}, 0));
  CHECK(deadband.send(ms(2), both, 0));
  CHECK_FALSE(deadband.send(ms(3), both, 0));
  CHECK(deadband.send(ms(4), {&a, 1}, 0));
  CHECK(deadband.send(ms(5), {}, 0));
  CHECK_FALSE(deadband.send(ms(6), {}, 0));
}

TEST_CASE("The low-pass of a deadband suppresses noise above its cutoff") {
  const DeadbandDef raw{.fraction = 0.1, .quantity = Quantity::kVelocity, .floor = 0.001};
  DeadbandDef smooth = raw;
  smooth.lowpass_Hz = 5;
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 0.02);
  Deadband a(raw), b(smooth);
  int sent_a = 0, sent_b = 0;
  for (int i = 0; i < 3000; ++i) {
    const Signal s{1, Quantity::kVelocity, {0.1 + noise(random), 0, 0}};
    sent_a += a.send(ms(i), {&s, 1}, 0);
    sent_b += b.send(ms(i), {&s, 1}, 0);
  }
  CHECK(sent_b < sent_a / 5);
}
