#include "haptic_node/devices/external.h"

#include <catch2/catch.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "haptic_node/devices/selection/make_device.h"
#include "lcmtypes/vectors.h"

using namespace tactus;
using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

sync::HostTime at_ms(double ms) { return sync::host_time(5'000'000'000 + static_cast<std::int64_t>(ms * 1e6)); }

// Sent at `ms` of the clock of the driver, which differs from ours.
device_state_t state_at(double ms, double x_m, std::int64_t incarnation = 1, const std::string& name = "arm") {
  device_state_t m{};
  m.header.publish_time_ns = 77'000'000'000 + static_cast<std::int64_t>(ms * 1e6);
  m.header.incarnation = incarnation;
  m.header.run_id = 1;
  m.device = name;
  m.pose.position_m.x = x_m;
  m.pose.orientation.w = 1;
  m.velocity_m_s.x = 0.1f;
  m.buttons = 5;
  return m;
}

External arm() { return External("arm", Vector3d(1, 2, 3), 0.05); }

}  // namespace

TEST_CASE("The position of an external device is the published position plus the offset") {
  External device = arm();
  CHECK(device.read(at_ms(0)).lost);  // no message yet
  CHECK(device.read(at_ms(0)).position == Vector3d(1, 2, 3));
  device.on_message(state_at(0, 0.1), at_ms(1));
  const DeviceState s = device.read(at_ms(1));
  CHECK_FALSE(s.lost);
  CHECK((s.position - Vector3d(1.1, 2, 3)).norm() < 1e-12);
  CHECK(s.velocity.x() == Approx(0.1));
  CHECK(s.buttons == 5);
}

TEST_CASE("States of another device are ignored") {
  External device = arm();
  device.on_message(state_at(0, 0.1, 1, "leg"), at_ms(1));
  CHECK(device.read(at_ms(1)).lost);
}

TEST_CASE("A silent driver loses the device at its last position until it publishes again") {
  External device = arm();
  device.on_message(state_at(0, 0.1), at_ms(0));
  CHECK_FALSE(device.read(at_ms(50)).lost);
  const DeviceState s = device.read(at_ms(50.1));
  CHECK(s.lost);
  CHECK(s.velocity.isZero());
  CHECK(s.buttons == 0);
  CHECK((s.position - Vector3d(1.1, 2, 3)).norm() < 1e-12);
  device.on_message(state_at(900, 0.9), at_ms(900));  // it may have moved any distance in the meantime
  CHECK_FALSE(device.read(at_ms(900)).lost);
  CHECK(device.read(at_ms(900)).position.x() == Approx(1.9));
}

TEST_CASE("A restarted driver is accepted after the old driver has been silent") {
  External device = arm();
  device.on_message(state_at(1000, 0.1, 1), at_ms(0));
  device.on_message(state_at(0, 0.3, 2), at_ms(60));  // another clock, far behind
  CHECK_FALSE(device.read(at_ms(60)).lost);
  CHECK(device.read(at_ms(60)).position.x() == Approx(1.3));
}

TEST_CASE("Two simultaneous drivers lose the device until only one publishes") {
  External device = arm();
  for (int ms = 0; ms < 200; ++ms) {
    device.on_message(state_at(ms, 0.1, 1), at_ms(ms));
    if (ms >= 100) device.on_message(state_at(ms, 0.4, 2), at_ms(ms));
    CHECK(device.read(at_ms(ms)).lost == (ms >= 100));
    CHECK(device.read(at_ms(ms)).position.x() == Approx(1.1));
  }
  for (int ms = 200; ms < 300; ++ms) {
    device.on_message(state_at(ms, 0.1, 1), at_ms(ms));
    CHECK(device.read(at_ms(ms)).lost == (ms < 249));  // 50 ms after the last contradiction, at 199
  }
}

TEST_CASE("A second commander loses the device for as long as it commands") {
  External device = arm();
  device_force_t others{};
  for (int ms = 0; ms < 300; ++ms) {
    device.on_message(state_at(ms, 0.1), at_ms(ms));
    others.device = ms < 100 ? "leg" : "arm";
    if (ms < 200) device.on_message(others, at_ms(ms));
    CHECK(device.read(at_ms(ms)).lost == (ms >= 100 && ms < 249));
  }
}

TEST_CASE("A jump of the pose is accepted only after a time of valid poses") {
  External device = arm();
  for (int ms = 0; ms < 100; ++ms) {
    // 0.4 m in 1 ms.
    device.on_message(state_at(ms, ms < 20 ? 0.1 : 0.5), at_ms(ms));
    const DeviceState s = device.read(at_ms(ms));
    CHECK(s.lost == (ms >= 20 && ms < 70));
    CHECK(s.position.x() == Approx(ms < 70 ? 1.1 : 1.5));
  }
}

TEST_CASE("A burst of queued messages is not a jump, by the times of its sender") {
  External device = arm();
  for (int ms = 0; ms < 40; ++ms) device.on_message(state_at(ms, 0.003 * ms), at_ms(40));  // 3 m/s
  CHECK_FALSE(device.read(at_ms(40)).lost);
  CHECK(device.read(at_ms(40)).position.x() == Approx(1.117));
}

TEST_CASE("Repeated and overtaken messages are ignored and do not extend the arrival time") {
  External device = arm();
  device.on_message(state_at(10, 0.1), at_ms(0));
  device.on_message(state_at(9, 0.2), at_ms(1));
  CHECK(device.read(at_ms(1)).position.x() == Approx(1.1));
  for (int ms = 2; ms < 100; ++ms) device.on_message(state_at(10, 0.1), at_ms(ms));
  CHECK(device.read(at_ms(99)).lost);
}

TEST_CASE("A driver that publishes LOST loses the device at once") {
  External device = arm();
  device.on_message(state_at(0, 0.1), at_ms(0));
  device_state_t m = state_at(1, 0.1);
  m.state = device_state_t::LOST;
  device.on_message(m, at_ms(1));
  CHECK(device.read(at_ms(1)).lost);
  device.on_message(state_at(2, 0.1), at_ms(2));
  CHECK_FALSE(device.read(at_ms(2)).lost);
}

TEST_CASE("The force message has the device name, the force and its validity") {
  const auto device = make_device(parse_device_spec("external:arm,offset=1/2/3"), {}, Vector3d::Zero(), {});
  device->write({1, -2, 3});
  const device_force_t* m = device->force_message();
  REQUIRE(m);
  CHECK(m->device == "arm");
  CHECK(m->force_N.y == -2);
  CHECK(m->valid_for_ns == 20'000'000);
  CHECK_FALSE(make_device({}, {}, Vector3d::Zero(), {})->force_message());  // a virtual hand has none
}
