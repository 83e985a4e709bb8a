#include "examples/device_driver/push_motion.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using tactus::examples::PushMotion;

namespace {

constexpr double kDt = 0.004;
constexpr int kFull = 350;

Eigen::Quaterniond orientation(const PushMotion& m) {
  const auto& [w, x, y, z] = m.orientation();
  return {w, x, y, z};
}

}  // namespace

TEST_CASE("A push of a 3D mouse moves the tool in the same direction: away along x, to the left along y, up along z") {
  struct Push {
    int x, y, z;                   // libspnav: right, up, towards the person
    std::array<double, 3> wanted;  // directions of ours
  };
  for (const Push& p :
       {Push{0, 0, -kFull, {1, 0, 0}}, Push{-kFull, 0, 0, {0, 1, 0}}, Push{0, kFull, 0, {0, 0, 1}}}) {
    PushMotion m(0.5);
    m.push(p.x, p.y, p.z, 0, 0, 0);
    m.step(kDt);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(m.velocity_m_s()[i] == Approx(0.3 * p.wanted[i]).margin(1e-12));
      CHECK(m.position_m()[i] == Approx(0.3 * kDt * p.wanted[i]).margin(1e-12));
    }
  }
}

TEST_CASE("Twists rotate by the right-hand rule about the axes of pushes with the same sign") {
  for (int axis = 0; axis < 3; ++axis) {
    PushMotion pushed(0.5), twisted(0.5);
    std::array<int, 3> full{};
    full[static_cast<std::size_t>(axis)] = kFull;
    pushed.push(full[0], full[1], full[2], 0, 0, 0);
    pushed.step(kDt);
    for (int i = 0; i < 250; ++i) {
      twisted.push(0, 0, 0, full[0], full[1], full[2]);
      twisted.step(kDt);
    }
    const Eigen::Vector3d along = Eigen::Vector3d::Map(pushed.velocity_m_s().data()).normalized();
    const Eigen::AngleAxisd turned(orientation(twisted));
    CHECK(turned.angle() == Approx(1.57).margin(1e-6));  // a quarter turn in a second
    CHECK((turned.axis() - along).norm() < 1e-6);
  }
}

TEST_CASE("A silent mouse stops the tool after 50 ms") {
  PushMotion m(0.5);
  m.push(0, kFull, 0, 0, kFull, 0);
  for (int i = 0; i < 100; ++i) m.step(kDt);
  CHECK(m.velocity_m_s()[2] == 0);
  CHECK(m.spin_rad_s()[2] == 0);
  CHECK(m.position_m()[2] > 0.3 * 0.05 - 1e-9);
  CHECK(m.position_m()[2] < 0.3 * (0.05 + 2 * kDt));
}

TEST_CASE("For any input the tool stays in its box, and its orientation is the integral of its angular velocity") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> any(-kFull, kFull);
  PushMotion m(0.2);
  Eigen::Quaterniond integrated = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 5000; ++i) {
    m.push(any(random), any(random), any(random), any(random), any(random), any(random));
    m.step(kDt);
    const Eigen::Vector3d by = kDt * Eigen::Vector3d::Map(m.spin_rad_s().data());
    integrated = Eigen::Quaterniond(Eigen::AngleAxisd(by.norm(), by.normalized())) * integrated;
    for (const double p : m.position_m()) CHECK(std::abs(p) <= 0.2);
    CHECK(orientation(m).norm() == Approx(1).margin(1e-12));
    CHECK(orientation(m).angularDistance(integrated) < 1e-5);
  }
}

TEST_CASE("Buttons are bits of a mask, and button numbers out of range are ignored") {
  PushMotion m(0.5);
  m.press(0, true);
  m.press(2, true);
  m.press(31, true);
  m.press(-1, true);
  CHECK(m.buttons() == 0b101);
  m.press(0, false);
  CHECK(m.buttons() == 0b100);
}
