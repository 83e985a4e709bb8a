#include "haptic_node/contact/proxy.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

Surface surface(const Vector3d& normal, double offset, double friction_static, double friction_dynamic) {
  Surface s;
  s.normal = normal.normalized();
  s.offset_m = offset;
  s.point = offset * s.normal;
  s.friction_static = friction_static;
  s.friction_dynamic = friction_dynamic;
  return s;
}

}  // namespace

TEST_CASE("In free space the proxy is at the device") {
  Proxy proxy;
  std::vector<Surface> none;
  proxy.reset(Vector3d::Zero());
  proxy.step(none, {0.1, 0.2, 0.3}, kDt);
  CHECK(proxy.position() == Vector3d(0.1, 0.2, 0.3));
}

TEST_CASE("The proxy never passes a surface at any device position, with and without friction") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> friction(0, 1.5);
  for (int round = 0; round < 200; ++round) {
    std::vector<Surface> surfaces;
    for (int i = 0; i < 1 + round % 8; ++i) {
      const double mu = round % 2 ? friction(random) : 0;
      surfaces.push_back(surface({normal(random), normal(random), normal(random)}, -0.002, mu, 0.8 * mu));
    }
    Proxy proxy;
    Vector3d device = Vector3d::Zero();
    proxy.reset(device);
    for (int k = 0; k < 200; ++k) {
      device += 5e-4 * Vector3d(normal(random), normal(random), normal(random));
      proxy.step(surfaces, device, kDt);
      Vector3d sum = device + proxy.shift();
      double cone = 0;
      for (const Surface& s : surfaces) {
        REQUIRE(s.normal.dot(proxy.position()) - s.offset_m > -2e-9);
        sum += s.depth_m * s.normal;
        cone += s.friction_static * s.depth_m;
      }
      REQUIRE((sum - proxy.position()).norm() < 1e-9);  // the displacement splits exactly
      REQUIRE(proxy.shift().norm() < 2 * cone + 1e-9);
    }
  }
}

TEST_CASE(
    "On one plane the proxy sticks up to the static friction angle and slips at the dynamic friction angle") {
  constexpr double kStatic = 0.6, kDynamic = 0.4, kDepth = 0.002;
  std::vector<Surface> floor{surface(Vector3d::UnitZ(), 0, kStatic, kDynamic)};
  Proxy proxy;
  proxy.reset({0, 0, 0.001});
  proxy.step(floor, {0, 0, -kDepth}, kDt);
  CHECK(proxy.position().norm() < 1e-12);
  double x = 0;
  // Angle of the force from the normal: atan(shift / depth). It sticks until x = mu_s depth = 1.2 mm.
  for (; x < kStatic * kDepth - 1e-5; x += 1e-5) {
    proxy.step(floor, {x, 0, -kDepth}, kDt);
    REQUIRE(proxy.position().norm() < 1e-12);
    REQUIRE_FALSE(proxy.slipping());
  }
  for (int k = 0; k < 200; ++k) {
    x += 1e-5;
    proxy.step(floor, {x, 0, -kDepth}, kDt);
  }
  CHECK(proxy.slipping());
  CHECK(proxy.shift().norm() / kDepth == Approx(kDynamic));
  CHECK(proxy.shift().x() < 0);  // against the motion
  SECTION("The proxy sticks again when the motion reverses") {
    const Vector3d stuck = proxy.position();
    proxy.step(floor, {x - 1e-5, 0, -kDepth}, kDt);
    proxy.step(floor, {x - 2e-5, 0, -kDepth}, kDt);
    CHECK_FALSE(proxy.slipping());
    CHECK((proxy.position() - stuck).norm() < 1e-12);
  }
  SECTION("The proxy returns to the device when it is lifted off") {
    proxy.step(floor, {x, 0, 0.001}, kDt);
    CHECK(proxy.position() == Vector3d(x, 0, 0.001));
    CHECK(proxy.shift().norm() == 0);
  }
}

TEST_CASE("Friction along the edge of two walls depends on both normal depths") {
  std::vector<Surface> corner{surface(Vector3d::UnitX(), 0, 0.5, 0.5), surface(Vector3d::UnitY(), 0, 0.5, 0.5)};
  Proxy proxy;
  proxy.reset({0.001, 0.001, 0});
  for (int k = 0; k < 1000; ++k) proxy.step(corner, {-0.003, -0.001, 1e-5 * k}, kDt);
  CHECK(proxy.shift().norm() == Approx(0.5 * (0.003 + 0.001)));
  CHECK(proxy.shift().z() < 0);
}

TEST_CASE("A moving surface carries the proxy") {
  std::vector<Surface> belt{surface(Vector3d::UnitZ(), 0, 1, 1)};
  belt[0].velocity = {0.1, 0, 0};
  Proxy proxy;
  proxy.reset({0, 0, 0.001});
  for (int k = 0; k < 11; ++k) proxy.step(belt, {0, 0, -0.01}, kDt);
  CHECK(proxy.position().x() == Approx(0.1 * 10 * kDt));
}

TEST_CASE("A proxy that sticks beside a wall does not jump to it") {
  // The device moves into the wall, but friction on the floor holds the proxy in front of it.
  std::vector<Surface> corner{surface(Vector3d::UnitZ(), 0, 0.8, 0.8),
                              surface(-Vector3d::UnitX(), -0.001, 0.8, 0.8)};
  Proxy proxy;
  proxy.reset({0, 0, 0});
  proxy.step(corner, {0, 0, -0.005}, kDt);
  for (double x = 0; x < 0.003; x += 1e-4) {
    proxy.step(corner, {x, 0, -0.005}, kDt);
    REQUIRE(proxy.position().norm() < 1e-12);  // within the cone of 4 mm
  }
}
