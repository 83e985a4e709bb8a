#include "haptic_node/devices/device_timing.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <random>

using namespace tactus;
using namespace tactus::haptic;

namespace {

sync::HostTime node_s(double s) { return sync::host_time(5'000'000'000 + std::llround(s * 1e9)); }

// A driver with a clock of its own, read by a node with ticks of 1 ms.
struct TimingRig {
  double interval_s, transit_s;
  DeviceTiming timing{false};
  double next_s = 0;
  std::deque<double> in_transit{};  // times of measurement
  double now_s = 0;

  DeviceLoop tick() {
    now_s += 1e-3;
    while (next_s <= now_s) in_transit.push_back(next_s), next_s += interval_s;
    while (!in_transit.empty() && in_transit.front() + transit_s <= now_s + 1e-12) {
      const double s = in_transit.front();
      in_transit.pop_front();
      timing.on_state(77'000'000'000 + std::llround(s * 1e9), transit_s, node_s(s + transit_s));
    }
    return timing.step(node_s(now_s));
  }
};

}  // namespace

TEST_CASE("The timing of a steady driver is its interval, its transit and whole intervals until its force acts") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (int round = 0; round < 200; ++round) {
    const double interval_s = 2.5e-4 * std::pow(80, u(random)), transit_s = 0.01 * u(random);
    TimingRig rig{interval_s, transit_s};
    CAPTURE(interval_s, transit_s);
    DeviceLoop loop;
    double motion_s = 0;
    for (int ms = 0; ms < 3000; ++ms) {
      loop = rig.tick();
      if (ms >= 1000) motion_s += loop.span_s;
    }
    CHECK(loop.interval_s == Approx(interval_s).epsilon(1e-6));
    CHECK(loop.period_s >= 0.999 * interval_s);
    // A gap in progress ends with the tick that follows the arrival.
    CHECK(loop.period_s <= interval_s + 1e-3 + 1e-9);
    CHECK(loop.force_delay_s == Approx(transit_s).margin(1e-6));
    // Each motion counts once.
    CHECK(motion_s == Approx(2).margin(1e-3 + interval_s));
    // Each way once, the wait for a tick, and the rest of an interval of the driver.
    CHECK(loop.delay_s >= std::max(2 * transit_s, interval_s) - 0.021 * interval_s);
    CHECK(loop.delay_s <= 2 * transit_s + 1e-3 + 1.03 * interval_s);
    CHECK(loop.age_s >= transit_s - 1e-9);
    CHECK(loop.age_s <= transit_s + interval_s + 1e-3);
  }
}

TEST_CASE("A driver that applies forces on arrival has no wait for its next state") {
  DeviceTiming timing(true);
  DeviceLoop loop;
  for (int ms = 0; ms < 1000; ++ms) {
    if (ms % 20 == 2) timing.on_state(1'000'000LL * (ms - 2), 0.002, node_s(1e-3 * ms));
    loop = timing.step(node_s(1e-3 * ms));
  }
  CHECK(loop.at_once);
  CHECK(loop.delay_s == Approx(0.004).margin(1e-6));
}

TEST_CASE("A driver that slows down is measured during its first long gap") {
  const double slow_s = GENERATE(0.005, 0.01, 0.02);
  TimingRig rig{1e-3, 1e-4};
  for (int ms = 0; ms < 1000; ++ms) REQUIRE(rig.tick().period_s < 2.1e-3);
  rig.interval_s = slow_s;
  double reached_s = 1;
  for (int ms = 1; ms <= 50; ++ms)
    if (rig.tick().period_s >= 0.95 * slow_s) reached_s = std::min(reached_s, 1e-3 * ms);
  CHECK(reached_s <= slow_s + 3e-3);
  // The delay follows with its first slow states.
  CHECK(rig.tick().delay_s > 0.95 * slow_s);
}

TEST_CASE("One late state softens for a few seconds only") {
  TimingRig rig{1e-3, 1e-4};
  for (int ms = 0; ms < 500; ++ms) rig.tick();
  rig.next_s += 0.03;
  for (int ms = 0; ms < 32; ++ms) rig.tick();
  CHECK(rig.tick().period_s > 0.029);
  for (int ms = 0; ms < 3500; ++ms) rig.tick();
  CHECK(rig.tick().period_s < 2.5e-3);
}

TEST_CASE("Stamps and transits of any value leave the timing finite and bounded") {
  std::mt19937_64 random(5);
  DeviceTiming timing(false);
  const double transits[] = {0, -1, 1e9, 1e-9, 0.05, 1e300, -1e300};
  double now_s = 0;
  for (int k = 0; k < 20000; ++k) {
    now_s += random() % 3 == 0 ? 0 : 1e-3;
    timing.on_state(static_cast<std::int64_t>(random() >> (1 + random() % 60)), transits[random() % 7], node_s(now_s));
    const DeviceLoop loop = timing.step(node_s(now_s));
    for (const double value : {loop.period_s, loop.interval_s, loop.span_s, loop.force_delay_s, loop.delay_s}) {
      REQUIRE(value >= 0);
      REQUIRE(value <= DeviceTiming::kMax_s);
    }
    REQUIRE(loop.period_s > 0);
    REQUIRE(std::isfinite(loop.age_s));
  }
}
