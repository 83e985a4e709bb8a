#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <tactus/scene_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/rendering/session.h"
#include "tests/haptic_node/support/node_config.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// Presses `depth` below z = 0 while it answers.
struct UnreliableDevice : Device {
  DeviceState read(sync::HostTime) override {
    DeviceState s;
    s.position = at;
    s.lost = lost;
    if (lost) s.velocity = Vector3d(9, 9, 9);  // must be ignored
    return s;
  }
  using Device::write;
  void write(const Wrench& wrench) override { force = wrench.force_N; }
  Vector3d at = Vector3d(0, 0, 0.002);  // the tool has a radius of 5 mm: 3 mm deep
  Vector3d force = Vector3d::Zero();
  bool lost = false;
};

struct LostRig {
  LostRig() : config(resolve_config(world, "", {})), safety(safety_limits(config.settings)) {
    auto made = std::make_unique<UnreliableDevice>();
    device = made.get();
    session.emplace(world, config, std::move(made), sync::OwnClock{1, 0, nullptr}, safety);
  }
  // One tick of 1 ms with a new touch model of a floor.
  tool_state_t& tick() {
    touch_model_t m = model(ms, {plane(3, Vector3d::Zero(), Vector3d::UnitZ())});
    m.header.publish_time_ns = m.clock.host_ns;
    session->push(m, host_ms(ms));
    return session->step(host_ms(ms++)).state;
  }
  double push() { return device->force.norm(); }

  scene_t world = scene();
  NodeConfig config;
  Safety safety;
  UnreliableDevice* device;
  std::optional<Session> session;
  int ms = 1;
};

}  // namespace

TEST_CASE("The force on a lost device fades to zero, and the state reports it") {
  LostRig r;
  for (int i = 0; i < 200; ++i) r.tick();
  const double before = r.push();
  REQUIRE(before > 0.5);
  r.device->lost = true;
  double last = before;
  for (int i = 0; i < 20; ++i) {
    const tool_state_t& s = r.tick();
    CHECK(r.push() <= last + 1e-9);
    CHECK(s.device_velocity_m_s.x == 0);
    last = r.push();
  }
  for (int i = 0; i < 500; ++i) {
    const tool_state_t& s = r.tick();
    CHECK(r.push() == 0);
    CHECK(s.fade == 0);
    for (const tool_constraint_t& c : s.constraints) CHECK(c.force_N.z == 0);  // no force on the bodies either
  }
  CHECK(r.session->device_lost());
  CHECK_FALSE(r.session->lost());  // the touch model is not lost
}

TEST_CASE("The force of a device that returns fades in at any position") {
  LostRig r;
  for (int i = 0; i < 200; ++i) r.tick();
  const double before = r.push();
  r.device->lost = true;
  for (int i = 0; i < 100; ++i) r.tick();
  r.device->lost = false;
  SECTION("The device returns inside the wall at its old position") {
    double last = 0;
    for (int i = 0; i < 300; ++i) {
      r.tick();
      CHECK(std::abs(r.push() - last) <= 2.0 + 1e-9);  // the slew limit, by a wide margin
      CHECK(r.push() < 1.5 * before + 0.1);
      last = r.push();
    }
    CHECK(r.session->device_lost() == false);
    CHECK(r.push() == Approx(before).epsilon(0.05));
  }
  SECTION("The device returns in free space: the force is zero") {
    r.device->at = Vector3d(0.5, 0.2, 0.3);
    for (int i = 0; i < 300; ++i) {
      r.tick();
      CHECK(r.push() < 1e-9);
    }
  }
  SECTION("The device returns below the floor: the force stays within its limit") {
    r.device->at = Vector3d(0.5, 0.2, -0.3);
    for (int i = 0; i < 300; ++i) {
      r.tick();
      CHECK(r.push() <= 8 + 1e-9);
    }
  }
}

TEST_CASE("A device that never answered has no force until it answers") {
  LostRig r;
  r.device->lost = true;
  for (int i = 0; i < 200; ++i) {
    r.tick();
    CHECK(r.push() == 0);
  }
  r.device->lost = false;
  for (int i = 0; i < 200; ++i) r.tick();
  CHECK(r.push() > 0.5);
}

TEST_CASE("A device that is lost every second tick has no jump of the force") {
  LostRig r;
  for (int i = 0; i < 200; ++i) r.tick();
  double last = r.push();
  for (int i = 0; i < 1000; ++i) {
    r.device->lost = i % 2 == 0;
    r.tick();
    CHECK(std::abs(r.push() - last) <= 2.0 + 1e-9);
    last = r.push();
  }
}
