#include "scripts/simulated_player/observer/impedance_arm.h"

#include <catch2/catch.hpp>
#include <limits>

namespace tactus::observer {
namespace {

PlayerParameters noiseless() {
  PlayerParameters player;
  player.motor_noise_share = player.motor_noise_N = 0;
  return player;
}

}  // namespace

TEST_CASE("A pushed impedance arm deflects by force over stiffness and returns") {
  PlayerParameters player = noiseless();
  ImpedanceArm arm(player, {0.1, 0, 0}, 1);
  const Eigen::Vector3d push(3, 0, -4);
  for (int i = 0; i < 5000; ++i) arm.step(Eigen::Vector3d::Zero(), push, 0.001);
  CHECK((arm.offset_m() - push / (player.stiffness_N_m + player.stiffness_rise_1_m * 5)).norm() < 1e-9);
  for (int i = 0; i < 5000; ++i) arm.step(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.001);
  CHECK((arm.position_m() - Eigen::Vector3d(0.1, 0, 0)).norm() < 1e-9);
}

TEST_CASE("A command moves the reference, and the impedance does not resist it") {
  PlayerParameters soft = noiseless(), stiff = noiseless();
  soft.stiffness_N_m = 100, stiff.stiffness_N_m = 800;
  ImpedanceArm a(soft, Eigen::Vector3d::Zero(), 1), b(stiff, Eigen::Vector3d::Zero(), 1);
  for (int i = 0; i < 300; ++i) {
    a.step({1.2, 0, 0}, Eigen::Vector3d::Zero(), 0.001);
    b.step({1.2, 0, 0}, Eigen::Vector3d::Zero(), 0.001);
  }
  CHECK(a.position_m() == b.position_m());
  // 1 m/s^2 after two muscle poles T of 40 ms: t^2 / 2 - 2 T t + 3 T^2. Each of the four stages is early by up to
  // a step at 0.22 m/s.
  CHECK(a.position_m().x() == Approx(0.045 - 0.024 + 0.0048).margin(4 * 0.001 * 0.22));
}

TEST_CASE("An arm ignores commands and forces that are not finite") {
  ImpedanceArm arm(noiseless(), Eigen::Vector3d::Zero(), 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  arm.step({nan, 0, 0}, {0, nan, 0}, 0.001);
  arm.step({1, 0, 0}, {0, 1, 0}, 0);
  CHECK(arm.position_m() == Eigen::Vector3d::Zero());
}

}  // namespace tactus::observer
