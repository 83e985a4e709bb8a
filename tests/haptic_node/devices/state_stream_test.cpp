#include "haptic_node/devices/state_stream.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "haptic_node/devices/external.h"

using namespace tactus;
using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

using Result = StateStream::Result;

sync::HostTime own_ms(double ms) { return sync::host_time(5'000'000'000 + static_cast<std::int64_t>(ms * 1e6)); }

// Of a driver on the clock of the node; by_ms: ahead of it.
device_state_t own_state(double ms, double by_ms = 0, double x_m = 0.1) {
  device_state_t m{};
  m.header.publish_time_ns = sync::to_ns(own_ms(ms + by_ms));
  m.header.incarnation = m.header.run_id = 1;
  m.header.seq = static_cast<std::int64_t>(ms);
  m.device = "arm";
  m.pose.position_m.x = x_m;
  m.pose.orientation.w = 1;
  return m;
}

External own_clock_arm() {
  External device("arm", Vector3d::Zero(), 0.05);
  device.set_clock({1, 0, nullptr});
  return device;
}

}  // namespace

TEST_CASE("States that are dated ahead of the clock lose the device and are named, however far ahead they are") {
  const double ahead_ms = GENERATE(1.5, 10, 1e3, 1e6);
  const bool known_clock = GENERATE(true, false);
  CAPTURE(ahead_ms, known_clock);
  External device("arm", Vector3d::Zero(), 0.05);
  if (known_clock) device.set_clock({1, 0, nullptr});
  for (int ms = 0; ms < 400; ++ms) {
    device.on_message(own_state(ms), own_ms(ms));
    // Another program moves the device into a wall, under the name and the incarnation of the true driver.
    if (ms >= 100 && ms < 200) device.on_message(own_state(ms, ahead_ms, 0.1 + 1e-4 * (ms - 100)), own_ms(ms + 0.3));
    const DeviceState s = device.read(own_ms(ms + 0.5));
    CHECK(s.lost == (ms >= 100 && ms < 249));
    CHECK(s.position.x() == 0.1);  // never where the false states say
    if (ms == 150) CHECK(device.problem(own_ms(ms + 0.5)).find("dated ahead of the clock") != std::string::npos);
  }
  CHECK(device.stream().count(StateFault::kAhead) == 100);
  CHECK(device.problem(own_ms(400)).empty());
}

TEST_CASE("On an unknown clock states that jump ahead of it lose the device") {
  External device("arm", Vector3d::Zero(), 0.05);
  device.set_clock({1, 4711, nullptr});
  const double other_ms = 72'000;  // the clock of the driver
  for (int ms = 0; ms < 300; ++ms) {
    device.on_message(own_state(ms, other_ms), own_ms(ms));
    if (ms >= 100 && ms < 150) device.on_message(own_state(ms, other_ms + 60'000, 0.11), own_ms(ms));
    const DeviceState s = device.read(own_ms(ms));
    CHECK(s.lost == (ms >= 100 && ms < 199));
    CHECK(s.position.x() == 0.1);
  }
}

TEST_CASE("Older states that repeat nothing lose the device, and repeated ones are counted only") {
  External device = own_clock_arm();
  for (int ms = 0; ms < 300; ++ms) {
    device.on_message(own_state(ms), own_ms(ms));
    device.on_message(own_state(ms), own_ms(ms + 0.1));  // the network repeats it
    if (ms > 5) device.on_message(own_state(ms - 5), own_ms(ms + 0.2));
    if (ms == 100) device.on_message(own_state(ms - 3.5), own_ms(ms + 0.3));
    CHECK(device.read(own_ms(ms + 0.5)).lost == (ms >= 100 && ms < 150));
    if (ms == 120) CHECK(device.problem(own_ms(ms + 0.5)).find("older than the newest one (1 so far)") != std::string::npos);
  }
  CHECK(device.stream().count(StateFault::kOld) == 1);
  CHECK(device.stream().repeated() == 300 + 294);
}

TEST_CASE("A small lead of false states hides no driver") {
  // A lead within the tolerance of the clock: the states of the true driver are then the old ones.
  External device = own_clock_arm();
  int lost = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    device.on_message(own_state(ms), own_ms(ms + 0.2));
    if (ms >= 500) device.on_message(own_state(ms, 0.9, 0.3), own_ms(ms + 0.3));
    lost += device.read(own_ms(ms + 0.5)).lost;
  }
  CHECK(lost >= 498);
}

TEST_CASE("A state that is not finite loses the device at once, is counted and leaves no trace") {
  std::mt19937 random(8);
  const double wrong[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (int round = 0; round < 40; ++round) {
    External device = own_clock_arm();
    for (int ms = 0; ms < 100; ++ms) device.on_message(own_state(ms), own_ms(ms));
    device_state_t m = own_state(100);
    const double value = wrong[random() % 2];
    switch (random() % 5) {
      case 0: m.pose.position_m.y = value; break;
      case 1: m.pose.orientation.x = value; break;
      case 2: m.velocity_m_s.z = static_cast<float>(value); break;
      case 3: m.spin_rad_s.x = static_cast<float>(value); break;
      default: m.pose.orientation = {}; break;  // no rotation at all
    }
    device.on_message(m, own_ms(100));
    const DeviceState s = device.read(own_ms(100));
    CHECK(s.lost);
    CHECK(s.position == Vector3d(0.1, 0, 0));
    CHECK(s.velocity.isZero());
    CHECK(device.stream().count(StateFault::kInvalid) == 1);
    CHECK(device.problem(own_ms(100)).find("not finite") != std::string::npos);
  }
}

TEST_CASE("A driver whose clock steps back returns after the silence of a lost device") {
  StateStream stream(sync::from_seconds(0.05), sync::Nanoseconds(0));
  stream.set_clock({1, 4711, nullptr});
  for (int ms = 0; ms < 100; ++ms) CHECK(stream.add(own_state(ms, 1e6), own_ms(ms)) != Result::kRejected);
  int first = -1, valid = -1;
  for (int ms = 100; ms < 400; ++ms) {
    const Result result = stream.add(own_state(ms, 0), own_ms(ms));
    if (result == Result::kRestarted && first < 0) first = ms;
    if (first >= 0 && valid < 0 && !stream.fault(own_ms(ms))) valid = ms;
  }
  CHECK(first == 150);
  CHECK(valid == 200);
}

TEST_CASE("The transit of a state is measured on the own clock and assumed on an unknown one") {
  const auto transit = [](std::int32_t clock, double ahead_ms) {
    StateStream stream(sync::from_seconds(0.05), sync::from_seconds(0.002));
    stream.set_clock({1, 4711, nullptr});
    for (int ms = 0; ms < 100; ++ms) {
      device_state_t m = own_state(ms, ahead_ms);
      m.header.clock = clock;
      stream.add(m, own_ms(ms + (ms < 50 ? 7 : 4)));
    }
    return stream.transit_s();
  };
  CHECK(transit(4711, 0) == Approx(0.004));  // the clock of the node, by its name
  CHECK(transit(0, 0) == Approx(0.004));     // the clock of the node, by its value
  CHECK(transit(12, 72'000) == Approx(0.002).margin(1e-5));
}
