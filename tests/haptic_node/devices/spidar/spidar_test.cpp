#include "haptic_node/devices/spidar/spidar.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <tactus/tool_def_t.hpp>
#include <tactus/waypoint_t.hpp>

#include "haptic_node/devices/selection/make_device.h"
#include "haptic_node/devices/spidar/simulated_strings.h"
#include "haptic_node/devices/virtual_hand.h"
#include "tests/haptic_node/support/random_grip.h"

using namespace tactus;
using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

sync::HostTime at_ms(double ms) { return sync::host_time(1'000'000'000 + static_cast<std::int64_t>(ms * 1e6)); }

// A hand whose motion the test sets, and which stores the force.
struct MovedHand : Device {
  explicit MovedHand(std::function<GripPose(double ms)> path) : path(std::move(path)) {}
  DeviceState read(sync::HostTime now) override {
    const GripPose p = path(sync::to_seconds(now - at_ms(0)) * 1e3);
    DeviceState s;
    s.position = p.position_m;
    s.orientation = p.orientation;
    return s;
  }
  using Device::write;
  void write(const Wrench& wrench) override { felt = wrench.force_N; }
  std::function<GripPose(double)> path;
  Vector3d felt = Vector3d::Zero();
};

struct Rig {
  Rig(const std::string& name, std::function<GripPose(double)> path, const Vector3d& origin = Vector3d::Zero())
      : frame(*known_frame(name)) {
    auto moved = std::make_unique<MovedHand>(std::move(path));
    hand = moved.get();
    auto simulated = std::make_unique<SimulatedStrings>(frame, origin, std::move(moved));
    strings = simulated.get();
    device = std::make_unique<Spidar>(frame, origin, std::move(simulated));
  }
  StringFrame frame;
  MovedHand* hand;
  SimulatedStrings* strings;
  std::unique_ptr<Spidar> device;
};

}  // namespace

TEST_CASE("A string device measures the pose of its grip to encoder resolution at any origin") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const Vector3d origin(0.3, -0.2, 1);
  const StringFrame f = *known_frame(name);
  const double r = 0.8 * f.workspace_radius_m, tilt = 0.8 * f.workspace_tilt_rad;
  const auto path = [&](double ms) {
    const double t = ms * 1e-3;
    return GripPose{origin + r * Vector3d(std::sin(2 * t), std::cos(3 * t), std::sin(t)).normalized(),
                    Eigen::Quaterniond(Eigen::AngleAxisd(tilt * std::sin(2 * t), Vector3d(1, 2, 3).normalized()))};
  };
  Rig rig(name, path, origin);
  for (int ms = 0; ms < 2000; ++ms) {
    const DeviceState s = rig.device->read(at_ms(ms));
    const GripPose truth = path(ms);
    REQUIRE_FALSE(s.lost);
    // Half a count on every string changes the pose by less than two counts anywhere in the workspace; three
    // including the read-out of a rotation.
    CHECK((s.position - truth.position_m).norm() < 3 * f.encoder_step_m);
    CHECK(s.orientation.angularDistance(truth.orientation) * f.lever_m() < 3 * f.encoder_step_m);
  }
}

TEST_CASE("The velocity is smooth when the grip is slow and prompt when it is fast") {
  Rig rig("desktop", [](double ms) {
    return GripPose{Vector3d(ms < 500 ? ms * 1e-5 : 0.005 + (ms - 500) * 3e-4, 0, 0),
                    Eigen::Quaterniond::Identity()};
  });
  double worst = 0;
  for (int ms = 0; ms < 700; ++ms) {
    const DeviceState s = rig.device->read(at_ms(ms));
    // One count in one tick would read as 29 mm/s. Over 19 ms two ends with an error of two counts each give 6
    // mm/s.
    if (ms > 50 && ms < 500) worst = std::max(worst, (s.velocity - Vector3d(0.01, 0, 0)).norm());
    if (ms == 505) CHECK(s.velocity.x() == Approx(0.3).epsilon(0.1));
  }
  CHECK(worst < 0.012);
}

TEST_CASE("A hand on strings feels the force that is written, a few time constants later") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const GripPose pose = test::random_pose(f, random);
    const Vector3d force = 2 * test::random_direction(random);
    Rig rig(name, [&](double) { return pose; });
    for (int ms = 0; ms < 20; ++ms) {
      rig.device->read(at_ms(ms));
      rig.device->write(force);
    }
    // The pose is known to about 50 um, a thousandth of the shortest string: this is the error of the directions,
    // times the 20 N of a few strings.
    CHECK((rig.hand->felt - force).norm() < 0.05);
    CHECK(rig.device->tensions().share == 1);
  }
}

TEST_CASE("The force fades to zero beyond the workspace and returns") {
  Rig rig("desktop", [](double ms) {
    return GripPose{Vector3d(0, 0, 0.16 - 0.00016 * std::abs(ms - 1000)), Eigen::Quaterniond::Identity()};
  });
  const Vector3d force(3, 0, 0);
  double last = 0;
  for (int ms = 0; ms <= 2000; ++ms) {
    const DeviceState s = rig.device->read(at_ms(ms));
    // the pose is still reported
    CHECK(s.position.z() == Approx(0.16 - 0.00016 * std::abs(ms - 1000)).margin(1e-4));
    rig.device->write(force);
    const double felt = rig.hand->felt.norm();
    if (ms == 200 || ms == 1800) CHECK(felt == Approx(3).margin(0.02));
    // Every string at its minimum: 0.16 m up, above the inner tetrahedron, their sum is below 0.7 N.
    if (ms == 1000) CHECK(felt < 0.7);
    if (ms > 10)
      CHECK(std::abs(felt - last) < 0.12);  // 3 N over 12 mm at 0.16 m/s is 0.04 N a tick, plus the idle tension
    last = felt;
  }
}

TEST_CASE("A slack string during a fast motion causes no jump of the pose") {
  // 9 m/s along the edge: strings at 55 degrees to it shorten at 5 m/s, faster than a motor winds.
  Rig rig("desktop", [](double ms) {
    return GripPose{Vector3d(ms < 20 ? -0.03 : std::min(0.03, -0.03 + (ms - 20) * 9e-3), 0, 0),
                    Eigen::Quaterniond::Identity()};
  });
  bool slack = false;
  for (int ms = 0; ms < 200; ++ms) {
    const DeviceState s = rig.device->read(at_ms(ms));
    rig.device->write({1, 0, 0});
    slack = slack || rig.strings->slack();
    CHECK(s.position.allFinite());
    if (!s.lost) CHECK((s.position - rig.strings->hand().position).norm() < 0.025);
  }
  CHECK(slack);
  CHECK_FALSE(rig.strings->slack());
  CHECK((rig.device->read(at_ms(200)).position - Vector3d(0.03, 0, 0)).norm() < 1e-4);
}

namespace {

// Strings that can be cut: a motor without load winds up its string.
struct BrokenString : StringMotors {
  Counts read(sync::HostTime) override {
    Counts c = Counts::Zero(4);
    if (broken) c(2) = -20'000;  // 0.58 m too short
    return c;
  }
  void write(const PerString& tensions_N) override { last = tensions_N; }
  bool broken = false;
  PerString last;
};

}  // namespace

TEST_CASE("A broken string loses the device and releases all other strings until it is repaired") {
  auto motors = std::make_unique<BrokenString>();
  BrokenString& strings = *motors;
  Spidar device(*known_frame("desktop"), Vector3d::Zero(), std::move(motors));
  for (int ms = 0; ms < 30; ++ms) {
    strings.broken = ms >= 10 && ms < 20;
    const DeviceState s = device.read(at_ms(ms));
    device.write({0, 0, 5});
    CHECK(s.lost == strings.broken);
    CHECK(s.position.norm() < 1e-9);  // the last known position
    CHECK((strings.last.maxCoeff() > 1) == !strings.broken);
  }
}

TEST_CASE("A string device is made by name, follows the path of its tool and yields to a force") {
  tool_def_t tool{};
  tool.name = "stylus";
  for (const double t : {0.0, 1.0}) {
    waypoint_t w{};
    w.time_s = t;
    w.position_m.x = 1 + 0.1 * t;
    tool.waypoints.push_back(w);
  }
  const auto device = make_device(parse_device_spec("spidar:desktop,offset=1.05/0/0"), tool, Vector3d::Zero(), {});
  device->begin(at_ms(0));
  DeviceState s;
  for (int ms = 0; ms < 3000; ++ms) {
    s = device->read(at_ms(ms));
    device->write(ms < 2000 ? Vector3d::Zero() : Vector3d(0, 0, 3));
    if (ms == 1900) CHECK((s.position - Vector3d(1.1, 0, 0)).norm() < 1e-4);
  }
  CHECK((s.position - Vector3d(1.1, 0, 0.01)).norm() < 3e-4);  // 3 N over the 300 N/m of the hand
  CHECK_THROWS_WITH(parse_device_spec("spidar:phantom"),
                    Catch::Contains("no such frame") && Catch::Contains("cave8"));
}
