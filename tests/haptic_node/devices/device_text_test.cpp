// The text of the health about a device, and the loss of a device whose numbers are invalid.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "haptic_node/devices/external.h"
#include "haptic_node/rendering/session.h"
#include "tests/haptic_node/support/node_config.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// Presses 3 mm into a floor at z = 0.
struct Pressing : Device {
  DeviceState read(sync::HostTime) override { return state; }
  using Device::write;
  void write(const Wrench& wrench) override { force_N = wrench.force_N.norm(); }
  DeviceState state;
  double force_N = 0;
};

struct TextRig {
  explicit TextRig(std::unique_ptr<Device> device)
      : config(resolve_config(world, "", {})), safety(safety_limits(config.settings)) {
    session.emplace(world, config, std::move(device), sync::OwnClock{1, 0, nullptr}, safety);
  }
  void tick() {
    touch_model_t m = model(ms, {plane(3, Vector3d::Zero(), Vector3d::UnitZ())});
    m.header.publish_time_ns = m.clock.host_ns;
    session->push(m, host_ms(ms));
    session->step(host_ms(ms++));
  }
  // A state of the driver, by_ms ahead of the clock.
  void send(double by_ms = 0) {
    device_state_t s{};
    s.header.publish_time_ns = sync::to_ns(host_ms(ms + by_ms));
    s.header.run_id = 1;
    s.header.incarnation = 5;
    s.header.seq = ms;
    s.device = "arm";
    s.pose.position_m.z = 0.002;
    s.pose.orientation.w = 1;
    session->push(s, host_ms(ms));
  }
  std::string text() { return session->device_text(host_ms(ms - 1)); }
  double force_N() { return session->force_message()->force_N.z; }

  scene_t world = scene();
  NodeConfig config;
  Safety safety;
  std::optional<Session> session;
  int ms = 1;
};

std::unique_ptr<Device> driven_arm() { return std::make_unique<External>("arm", Vector3d::Zero(), 0.05); }

}  // namespace

TEST_CASE("The health text names the timing of a slow driver and the stiffness that it leaves") {
  TextRig fast(driven_arm()), slow(driven_arm());
  for (int i = 0; i < 1000; ++i) {
    fast.send();
    fast.tick();
    if (i % 10 == 0) slow.send();
    slow.tick();
  }
  CHECK(fast.text().empty());
  CHECK(slow.text() == "the device sends every 10.0 ms and its force acts 10 ms later: touch is softer, at most 267 N/m");
  CHECK(slow.force_N() > 0.3);  // the hand did no work on the way in, so the controller gives half of the force
}

TEST_CASE("States ahead of the clock fade the force to zero within 20 ms and are named") {
  TextRig r(driven_arm());
  for (int i = 0; i < 500; ++i) r.send(), r.tick();
  REQUIRE(r.force_N() > 0.3);
  for (int i = 0; i < 200; ++i) {
    r.send();
    r.send(3'600'000);
    r.tick();
    if (i >= 20) CHECK(r.force_N() == 0);
  }
  CHECK(r.session->device_lost());
  CHECK(r.text() == "the device \"arm\" sends states that are dated ahead of the clock (200 so far)");
  for (int i = 0; i < 200; ++i) r.send(), r.tick();
  CHECK(r.text().empty());
  CHECK(r.force_N() > 0.2);
}

TEST_CASE("A device whose state is not finite is lost, and its force fades to zero") {
  const double wrong = GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  const int field = GENERATE(0, 1, 2, 3);
  auto made = std::make_unique<Pressing>();
  Pressing& device = *made;
  device.state.position = {0, 0, 0.002};
  TextRig r(std::move(made));
  for (int i = 0; i < 200; ++i) r.tick();
  REQUIRE(device.force_N > 0.5);
  DeviceState& s = device.state;
  const DeviceState good = s;
  if (field == 0) s.position.x() = wrong;
  if (field == 1) s.velocity.y() = wrong;
  if (field == 2) s.spin.z() = wrong;
  if (field == 3) s.orientation.x() = wrong;
  for (int i = 0; i < 21; ++i) r.tick();
  CHECK(device.force_N == 0);
  CHECK(r.session->device_lost());
  s = good;
  for (int i = 0; i < 200; ++i) r.tick();
  CHECK(device.force_N > 0.5);
}
