#include "haptic_node/contact/surfaces.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/contact/proxy.h"
#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

sync::SimTime sim_ms(double ms) { return sync::sim_time(static_cast<std::int64_t>(ms * 1e6)); }

// Surfaces and proxy together, with a fixed device.
struct Touch {
  explicit Touch(double radius_m = 0) : surfaces(radius_m, SurfaceLimits{}) { proxy.reset(Vector3d(0, 0, 0.01)); }
  void tick(double ms, const Vector3d& device, const touch_model_t* fresh) {
    surfaces.step(fresh, sim_ms(ms), proxy.position(), kDt);
    proxy.step(surfaces.list(), device, kDt);
  }
  Surfaces surfaces;
  Proxy proxy;
};

}  // namespace

TEST_CASE("A plane keeps the centre of the tool a radius away") {
  Touch touch(0.005);
  const auto m = model(0, {plane(7, {0, 0, 1}, Vector3d::UnitZ())});
  touch.proxy.reset({0, 0, 1.1});
  touch.tick(0, {0, 0, 1.1}, &m);
  touch.tick(1, {0, 0, 0.9}, nullptr);
  CHECK(touch.proxy.position().z() == Approx(1.005));
}

TEST_CASE("A surface remembers how deep the tool was when it appeared") {
  Touch touch;
  touch.proxy.reset({0, 0, -0.003});
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  for (int ms = 0; ms < 30; ++ms) {
    touch.tick(ms, {0, 0, ms < 20 ? -0.003 : -0.008}, &m);
    CHECK(touch.surfaces.list()[0].appeared_m == Approx(0.003));
  }
}

TEST_CASE("A surface that the tool reaches has not appeared above it") {
  Touch touch;
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  for (const double z : {0.01, -0.003, -0.003}) touch.tick(0, {0, 0, z}, &m);
  CHECK(touch.surfaces.list()[0].depth_m == Approx(0.003));
  CHECK(touch.surfaces.list()[0].appeared_m == 0);
}

TEST_CASE("A late model that renames a fixed surface under the hand changes nothing") {
  Touch touch;
  // The plane of body 0 has another id from 50 ms on, at another place of the same plane.
  for (int ms = 0; ms < 100; ++ms) {
    const auto m = model(ms, {plane(ms < 50 ? 7 : 8, {1e-4 * ms, 0, 0}, Vector3d::UnitZ())});
    touch.tick(ms, {0, 0, ms < 10 ? 0.002 : -0.003}, &m);
    if (ms < 10) continue;
    CAPTURE(ms);
    REQUIRE(touch.surfaces.list().size() == 1);
    CHECK(touch.surfaces.list()[0].contact_id == (ms < 50 ? 7 : 8));
    CHECK(touch.surfaces.list()[0].depth_m == Approx(0.003));
  }
}

TEST_CASE("A plane of another place, body, direction or of a moving body does not continue a surface") {
  touch_plane_t other = plane(8, Vector3d::Zero(), Vector3d::UnitZ()), first = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
  SECTION("another height") { other = plane(8, {0, 0, 0.0015}, Vector3d::UnitZ()); }
  SECTION("another direction") { other = plane(8, Vector3d::Zero(), Vector3d(0.2, 0, 1)); }
  SECTION("another body") { other.body = 1; }
  SECTION("another point of the tool") { other.tool_point_m.x = 0.002f; }
  SECTION("a movable body") { first.effective_mass_kg = other.effective_mass_kg = 1; }
  SECTION("a conveyor") { first.velocity_m_s.x = other.velocity_m_s.x = 0.1f; }
  SECTION("both in the model") {}
  const bool both = other.point_m.z == 0 && other.body == 0 && other.normal.x == 0 && other.tool_point_m.x == 0 &&
                    other.effective_mass_kg > 1e9f && other.velocity_m_s.x == 0;
  Touch touch;
  for (int ms = 0; ms < 20; ++ms) {
    const auto m = model(ms, {first});
    touch.tick(ms, {0, 0, ms < 10 ? 0.002 : -0.003}, &m);
  }
  const auto m = model(20, both ? std::vector{first, other} : std::vector{other});
  touch.tick(20, {0, 0, -0.003}, &m);
  CHECK(touch.surfaces.list().size() == 2);
}

TEST_CASE("A fixed surface that appears deep above the hand rises by the given energy, and follows the hand that leaves") {
  Touch touch;
  touch.proxy.reset({0, 0, -0.01});
  touch.surfaces.set_rise(0.001, 0);
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  const auto depth_at = [&](double z) {
    touch.tick(0, {0, 0, z}, &m);
    touch.surfaces.list()[0].coupling_stiffness_N_m = 1000;
    return touch.surfaces.list()[0].depth_m;
  };
  // Without energy it stays where the hand was, and is pressed from there.
  for (int k = 0; k < 100; ++k) CHECK(depth_at(-0.01) == Approx(0).margin(1e-9));
  CHECK(depth_at(-0.012) == Approx(0.002));
  // A rise of z at 2 mm takes 1000 N/m (2 mm z + z^2 / 2): 0.01 mJ a tick.
  touch.surfaces.set_rise(0.001, 1e-5);
  const double once_m = std::sqrt(4e-6 + 2e-8) - 0.002;
  CHECK(depth_at(-0.012) == Approx(0.002 + once_m));
  touch.surfaces.set_rise(0.001, 0);
  CHECK(depth_at(-0.012) == Approx(0.002 + once_m));
  // A hand that leaves feels nothing, and meets the surface at its true height when it returns.
  for (double z = -0.009; z < 0.003; z += 0.0005) CHECK(depth_at(z) == Approx(0).margin(1e-9));
  CHECK(depth_at(-0.002) == Approx(0.002));
  CHECK_FALSE(touch.surfaces.list()[0].held);
}

TEST_CASE("Shallow, movable and first surfaces rise within the recovery time") {
  auto p = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
  double deep_m = 0.001, hand_m = -0.01;
  SECTION("shallow") { hand_m = -0.0009; }
  SECTION("movable") { p.effective_mass_kg = 1; }
  SECTION("first") { deep_m = std::numeric_limits<double>::infinity(); }
  Touch touch;
  touch.proxy.reset({0, 0, hand_m});
  touch.surfaces.set_rise(deep_m, 0);
  const auto m = model(0, {p});
  for (int k = 0; k < 100; ++k) touch.tick(0, {0, 0, hand_m}, &m);
  CHECK(touch.surfaces.list()[0].depth_m == Approx(-hand_m).epsilon(1e-3));
}

TEST_CASE("Between messages a plane is extrapolated with its velocity for a limited time") {
  Surfaces surfaces(0, SurfaceLimits{});
  auto p = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
  p.velocity_m_s = to_vec3f(Vector3d(0, 0, -0.2));
  const auto m = model(0, {p});
  surfaces.step(&m, sim_ms(0), {0, 0, 1}, kDt);
  CHECK(surfaces.list()[0].offset_m == Approx(0).margin(1e-12));
  surfaces.step(nullptr, sim_ms(5), {0, 0, 1}, kDt);
  CHECK(surfaces.list()[0].offset_m == Approx(-0.001).epsilon(1e-6));
  surfaces.step(nullptr, sim_ms(500), {0, 0, 1}, kDt);
  CHECK(surfaces.list()[0].offset_m == Approx(-0.2 * 0.02).epsilon(1e-6));
}

TEST_CASE("Between messages a plane rotates with its body") {
  Surfaces surfaces(0, SurfaceLimits{});
  auto p = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
  p.angular_velocity_rad_s = to_vec3f(Vector3d(0, 2, 0));
  const auto m = model(0, {p});
  surfaces.step(&m, sim_ms(0), {0, 0, 1}, kDt);
  surfaces.step(nullptr, sim_ms(10), {0, 0, 1}, kDt);
  // Right-handed about y: z turns towards x.
  CHECK((surfaces.list()[0].normal - Vector3d(std::sin(0.02), 0, std::cos(0.02))).norm() < 1e-6);
}

TEST_CASE("A jump of a pressed surface is spread over the recovery time") {
  Touch touch;
  const Vector3d device(0, 0, -0.002);
  const auto before = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  touch.tick(0, {0, 0, 0.01}, &before);
  for (int ms = 1; ms <= 30; ++ms) touch.tick(ms, device, nullptr);
  CHECK(touch.proxy.position().z() == Approx(0).margin(1e-9));
  const double jump = GENERATE(0.006, -0.0018);
  const auto after = model(31, {plane(7, {0, 0, jump}, Vector3d::UnitZ())});
  double last = touch.proxy.position().z();
  for (int ms = 31; ms <= 50; ++ms) {
    touch.tick(ms, device, ms == 31 ? &after : nullptr);
    const double z = touch.proxy.position().z();
    // A step lasts 15 ticks, or is 0.1 mm when that is faster.
    CHECK(std::abs(z - last) < std::max(std::abs(jump) / 15, 1e-4) * 1.001 + 1e-9);
    last = z;
  }
  CHECK(last == Approx(jump).margin(1e-9));
}

TEST_CASE("A slowly changing surface is followed without a lag") {
  Touch touch;
  for (int ms = 0; ms < 100; ++ms) {
    const double z = 0.00009 * ms;  // 0.09 m/s, not in the message
    const auto m = model(ms, {plane(7, {0, 0, z}, Vector3d::UnitZ())});
    touch.tick(ms, {0, 0, z - 0.002}, &m);
    CHECK(touch.proxy.position().z() == Approx(z).margin(1e-9));
  }
}

TEST_CASE("A pressed surface that the model omits retracts within the recovery time") {
  Touch touch;
  const Vector3d device(0, 0, -0.003);
  const auto with = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  touch.tick(0, {0, 0, 0.01}, &with);
  for (int ms = 1; ms <= 20; ++ms) touch.tick(ms, device, nullptr);
  const auto without = model(21, {});
  double last = touch.proxy.position().z();
  for (int ms = 21; ms <= 38; ++ms) {
    touch.tick(ms, device, ms == 21 ? &without : nullptr);
    CHECK(last - touch.proxy.position().z() < 0.003 / 15 * 1.05);
    CHECK(touch.proxy.position().z() <= last + 1e-12);
    last = touch.proxy.position().z();
  }
  CHECK(last == Approx(device.z()).margin(1e-9));
  CHECK(touch.surfaces.list().empty());
}

TEST_CASE("A surface that appears over the proxy lifts it within the recovery time") {
  Touch touch;
  const Vector3d device(0, 0, 0);
  touch.tick(0, device, nullptr);
  const auto m = model(1, {plane(7, {0, 0, 0.015}, Vector3d::UnitZ())});
  double last = 0;
  for (int ms = 1; ms <= 20; ++ms) {
    touch.tick(ms, device, ms == 1 ? &m : nullptr);
    CHECK(touch.proxy.position().z() - last < 0.015 / 15 * 1.001 + 1e-9);
    last = touch.proxy.position().z();
  }
  CHECK(last == Approx(0.015));
}

TEST_CASE("A jump of the normal of a pressed surface is spread over the recovery time, about the proxy") {
  Touch touch;
  const auto flat = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  touch.tick(0, {0, 0, 0.01}, &flat);
  const Vector3d device(0, 0, -0.001);
  for (int ms = 1; ms < 20; ++ms) touch.tick(ms, device, nullptr);
  const auto steep = model(20, {plane(7, Vector3d::Zero(), Vector3d::UnitX())});
  Vector3d last = touch.surfaces.list()[0].normal;
  for (int ms = 20; ms < 40; ++ms) {
    touch.tick(ms, device, ms == 20 ? &steep : nullptr);
    if (touch.surfaces.list().empty()) break;
    const Vector3d n = touch.surfaces.list()[0].normal;
    CHECK(std::acos(std::min(1.0, n.dot(last))) < M_PI / 2 / 15 * 1.001 + 1e-9);
    last = n;
  }
  CHECK((last - Vector3d::UnitX()).norm() < 1e-6);
}

TEST_CASE("The number of surfaces never exceeds the capacity of the solver") {
  Touch touch;
  for (int ms = 0; ms < 100; ++ms) {
    std::vector<touch_plane_t> planes;
    for (int i = 0; i < 60; ++i)
      planes.push_back(plane(100 * ms + i, {0, 0, 0.001 * (i % 3)}, Vector3d(0.1 * (i % 5), 0.1 * (i % 7), 1)));
    const auto m = model(ms, planes);
    touch.tick(ms, {0, 0, -0.01}, &m);
    REQUIRE(touch.surfaces.list().size() <= kMaxHalfSpaces);
    REQUIRE(touch.proxy.position().allFinite());
  }
}
