#include "haptic_node/devices/virtual_hand.h"

#include <catch2/catch.hpp>

using namespace tactus;
using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

const HandImpedance kHand{0.1, 10, 300};

MonotoneCubic still(const Vector3d& at) { return MonotoneCubic({0}, {at}, MonotoneCubic::Ends::kRest); }
sync::HostTime hand_ms(double ms) { return sync::host_time(1'000'000'000 + static_cast<std::int64_t>(ms * 1e6)); }

}  // namespace

TEST_CASE("A hand under a constant force rests at force over stiffness from its path") {
  VirtualHand hand(still({0.1, 0.2, 0.3}), false, kHand);
  DeviceState state;
  for (int ms = 0; ms < 2000; ++ms) {
    state = hand.read(hand_ms(ms));
    hand.write({0, 0, 3});
  }
  // Decay: the roots of 0.1 s^2 + 10 s + 300 are -50 +- 22i, so after 2 s the motion has decayed completely.
  CHECK((state.position - Vector3d(0.1, 0.2, 0.31)).norm() < 1e-12);
  CHECK(state.velocity.norm() < 1e-12);
}

TEST_CASE("A hand is integrated exactly at any step size") {
  // m x'' + b x' + k x = F from rest: x(t) of an overdamped, an underdamped and a critical hand.
  for (const HandImpedance& h :
       {HandImpedance{0.1, 30, 300}, HandImpedance{0.1, 2, 300}, HandImpedance{0.1, 10, 250}}) {
    const double a = h.damping_N_s_m / (2 * h.mass_kg), w2 = h.stiffness_N_m / h.mass_kg;
    const auto closed = [&](double t) {
      const double q = a * a - w2, rest = 1 / h.stiffness_N_m;
      if (std::abs(q) < 1e-9) return rest * (1 - std::exp(-a * t) * (1 + a * t));
      const double r = std::sqrt(std::abs(q));
      return rest * (1 - std::exp(-a * t) * (q > 0 ? std::cosh(r * t) + a / r * std::sinh(r * t)
                                                   : std::cos(r * t) + a / r * std::sin(r * t)));
    };
    for (const double step_ms : {0.25, 1.0, 7.0}) {
      VirtualHand hand(still(Vector3d::Zero()), false, h);
      for (double ms = 0; ms < 100; ms += step_ms) {
        const DeviceState state = hand.read(hand_ms(ms));
        CHECK(state.position.x() == Approx(closed(ms * 1e-3)).margin(1e-12));
        hand.write({1, 0, 0});
      }
    }
  }
}

TEST_CASE("A hand follows its path and repeats it without a jump") {
  const MonotoneCubic path({0, 0.5, 1}, {Vector3d::Zero(), {0.1, 0, 0}, Vector3d::Zero()},
                           MonotoneCubic::Ends::kRest);
  VirtualHand hand(path, true, kHand);
  hand.begin(hand_ms(0));
  Vector3d last = hand.read(hand_ms(0)).position;
  CHECK(last == Vector3d::Zero());
  for (int ms = 1; ms < 5000; ++ms) {
    const DeviceState state = hand.read(hand_ms(ms));
    // Fastest on the path: 1.5 * 0.1 m / 0.5 s = 0.3 m/s; the hand overshoots that by less than half.
    CHECK((state.position - last).norm() < 0.45e-3);
    last = state.position;
  }
  // 0.5 s after a start it is near the far end. Lag of a second-order follower whose damper uses the velocity of
  // the target: m/k times the acceleration, at most 0.1/300 * 6 * 0.1/0.25 = 0.8 mm.
  CHECK((hand.read(hand_ms(5500)).position - Vector3d(0.1, 0, 0)).norm() < 0.0008);
}

TEST_CASE("A hand rests at the first point until the path begins, and a force displaces it") {
  const MonotoneCubic path({0, 0.5}, {{0.1, 0, 0}, {0.2, 0, 0}}, MonotoneCubic::Ends::kRest);
  VirtualHand hand(path, false, kHand);
  for (int ms = 0; ms < 700; ++ms) CHECK(hand.read(hand_ms(ms)).position == Vector3d(0.1, 0, 0));
  SECTION("The path begins and has its full duration") {
    hand.begin(hand_ms(699.5));
    for (int ms = 700; ms <= 949; ++ms) hand.read(hand_ms(ms));
    CHECK(hand.read(hand_ms(949.5)).position.x() == Approx(0.15).margin(2e-4));  // except for the lag of the hand
    CHECK(hand.read(hand_ms(1600)).position.x() == Approx(0.2).epsilon(1e-6));
  }
  SECTION("A force displaces the hand") {
    for (int ms = 700; ms < 1700; ++ms) {
      hand.write({0, 0, 3});
      hand.read(hand_ms(ms));
    }
    CHECK((hand.read(hand_ms(1700)).position - Vector3d(0.1, 0, 0.01)).norm() < 1e-9);
  }
}

TEST_CASE("A force that is not renewed is dropped") {
  VirtualHand hand(still(Vector3d::Zero()), false, kHand);
  hand.read(hand_ms(0));
  hand.write({0, 0, 8});
  CHECK(hand.read(hand_ms(3000)).position.norm() < 1e-9);
}
