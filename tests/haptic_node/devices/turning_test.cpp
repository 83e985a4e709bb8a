// Rotating devices: torque on the hand, spin from it.
#include <catch2/catch.hpp>
#include <tactus/device_state_t.hpp>

#include "haptic_node/devices/external.h"
#include "haptic_node/devices/playback.h"
#include "haptic_node/devices/spidar/simulated_strings.h"
#include "haptic_node/devices/spidar/spidar.h"
#include "haptic_node/devices/virtual_hand.h"
#include "haptic_node/contact/rotation_math.h"
#include "lcmtypes/vectors.h"

using namespace tactus;
using namespace tactus::haptic;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

sync::HostTime ms(double t) { return sync::host_time(static_cast<std::int64_t>(t * 1e6)); }

}  // namespace

TEST_CASE("A virtual hand rotates by torque over stiffness and returns") {
  const Quaterniond rest(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  VirtualHand hand(MonotoneCubic({0}, {Vector3d::Zero()}, MonotoneCubic::Ends::kRest), false, {}, rest);
  CHECK(rotation_between(hand.read(ms(0)).orientation, rest).norm() < 1e-12);
  const Vector3d torque(0, 0.05, 0.02);
  DeviceState state;
  Vector3d turned = Vector3d::Zero();
  for (int i = 1; i < 2000; ++i) {
    hand.write(Wrench{Vector3d::Zero(), torque});
    const Quaterniond before = state.orientation;
    state = hand.read(ms(i));
    // Spin is the rotation rate.
    if (i > 2)
      CHECK((rotation_between(before, state.orientation) / 1e-3 - state.spin).norm() <
            0.05 * (1 + state.spin.norm()));
    turned = rotation_between(rest, state.orientation);
  }
  CHECK((turned - torque / HandImpedance{}.turn_stiffness_N_m).norm() < 1e-4);
  CHECK(state.position.norm() < 1e-12);
  for (int i = 2000; i < 4000; ++i) {
    hand.write(Wrench{});
    state = hand.read(ms(i));
  }
  CHECK(rotation_between(rest, state.orientation).norm() < 1e-6);
}

TEST_CASE("The spin of a recorded motion is its rotation rate") {
  Motion motion;
  motion.times_s = {0, 1};
  motion.positions_m = {Vector3d::Zero(), Vector3d::Zero()};
  motion.orientations = {Quaterniond::Identity(), Quaterniond(Eigen::AngleAxisd(0.5, Vector3d::UnitX()))};
  Playback device(motion, {});
  device.begin(ms(0));
  for (int i = 0; i < 900; ++i) {
    const DeviceState s = device.read(ms(i));
    if (i > 0) CHECK((s.spin - Vector3d(0.5, 0, 0)).norm() < 1e-6);
  }
}

TEST_CASE("An external device receives the torque and publishes its spin") {
  External device("stylus", Vector3d::Zero(), 0.05);
  device_state_t m{};
  m.device = "stylus";
  m.header.incarnation = 3;
  m.header.publish_time_ns = 1;
  m.pose.orientation.w = 1;
  m.spin_rad_s = to_vec3f(Vector3d(0, 0, 2));
  device.on_message(m, ms(0));
  CHECK((device.read(ms(1)).spin - Vector3d(0, 0, 2)).norm() < 1e-6);
  device.write(Wrench{{1, 2, 3}, {0.1, 0.2, 0.3}});
  CHECK((to_eigen(device.force_message()->torque_N_m) - Vector3d(0.1, 0.2, 0.3)).norm() < 1e-6);
  CHECK((to_eigen(device.force_message()->force_N) - Vector3d(1, 2, 3)).norm() < 1e-6);
  CHECK(device.read(ms(100)).spin.norm() == 0);  // lost
}

TEST_CASE("Composing and decomposing rotations is lossless") {
  for (const double angle : {0.0, 1e-9, 0.3, 3.1}) {
    const Vector3d turn = angle * Vector3d(2, -1, 0.5).normalized();
    const Quaterniond from(Eigen::AngleAxisd(1, Vector3d::UnitX()));
    CHECK((rotation_between(from, rotated_by(turn, from)) - turn).norm() < 1e-9);
  }
}

TEST_CASE("Eight strings render torque and measure the spin, four strings ignore torque") {
  for (const std::string name : {"desktop8", "desktop"}) {
    const StringFrame frame = *known_frame(name);
    auto hand = std::make_unique<VirtualHand>(MonotoneCubic({0}, {Vector3d::Zero()}, MonotoneCubic::Ends::kRest),
                                              false, HandImpedance{});
    Spidar device(frame, Vector3d::Zero(),
                  std::make_unique<SimulatedStrings>(frame, Vector3d::Zero(), std::move(hand)));
    DeviceState state;
    double fastest = 0;
    for (int i = 0; i < 1500; ++i) {
      state = device.read(ms(i));
      device.write(Wrench{Vector3d::Zero(), i < 100 ? Vector3d(0, 0, 0) : Vector3d(0, 0, 0.03)});
      fastest = std::max(fastest, state.spin.z());
    }
    const Vector3d turned = rotation_between(Quaterniond::Identity(), state.orientation);
    CAPTURE(name, turned.transpose(), fastest);
    if (frame.has_torque()) {
      CHECK(turned.z() == Approx(0.03 / HandImpedance{}.turn_stiffness_N_m).epsilon(0.1));
      CHECK(fastest > 0.3);
      CHECK(state.spin.norm() < 0.05);
    } else {
      CHECK(turned.norm() < 1e-6);
    }
  }
}
