#include "haptic_node/rendering/quality.h"

#include <catch2/catch.hpp>
#include <tactus/touch_plane_t.hpp>

#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// Ticks of 1 ms that take `full_ms` with all planes, and half of it at each further step.
int run(Quality& quality, double full_ms, int ticks) {
  for (int i = 0; i < ticks; ++i) quality.add(sync::from_seconds(full_ms * 1e-3 / std::pow(2, quality.step())));
  return quality.step();
}

Settings held(const std::string& quality) {
  Settings s;
  s.quality = quality;
  return s;
}

// A pit: a floor at z = 0 and four walls, 4 mm from the middle there, which lean outwards by `lean`.
std::vector<touch_plane_t> pit(double lean) {
  std::vector<touch_plane_t> planes{plane(1, Vector3d::Zero(), Vector3d::UnitZ())};
  const std::array<Vector3d, 4> in{Vector3d(-1, 0, 0), Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0, 1, 0)};
  for (const Vector3d& n : in)
    planes.push_back(
        plane(static_cast<std::int64_t>(planes.size()) + 1, -0.004 * n, n + lean * Vector3d::UnitZ()));
  return planes;
}

// Presses into the pit while the number of planes changes; only the force limit applies, so no limit hides a step.
struct Pressing {
  double lean;
  Bench bench{free()};
  Vector3d last = Vector3d::Zero();
  double largest_step_N = 0;

  static Settings free() {
    Settings s;
    s.slew_limit_N_s = 1e5;
    s.force_limit_N = 30;
    return s;
  }
  Vector3d press(int from_ms, int to_ms, const Vector3d& device, std::size_t planes) {
    for (int ms = from_ms; ms < to_ms; ++ms) {
      const auto m = model(ms, pit(lean));
      TickInput in;
      in.planes = planes;
      const Vector3d force = bench.tick(ms, device, &m, {}, in).force_N;
      if (ms > 0) largest_step_N = std::max(largest_step_N, (force - last).norm());
      last = force;
    }
    return last;
  }
};

}  // namespace

TEST_CASE("The number of planes falls when ticks take half of their period and recovers later") {
  Quality quality(Settings{});
  CHECK(run(quality, 0.4, 4000) == 0);
  CHECK(quality.planes() == 50);
  CHECK(run(quality, 0.6, 700) == 1);
  CHECK(quality.planes() == 5);
  CHECK(run(quality, 2, 700) == 2);
  CHECK(quality.planes() == 3);
  CHECK(run(quality, 0.3, 1000) == 2);
  CHECK(run(quality, 0.3, 30000) == 0);
}

TEST_CASE("A short preemption by another process does not reduce the quality") {
  Quality quality(Settings{});
  for (int i = 0; i < 10000; ++i) {
    // 30 ms of each 200 ms.
    quality.add(sync::from_seconds(i % 200 < 30 ? 0.8e-3 : 0.07e-3));
    REQUIRE(quality.step() == 0);
  }
}

TEST_CASE("A fixed quality ignores the tick time") {
  Quality quality(held("1"));
  CHECK(run(quality, 5, 1000) == 1);
  CHECK(quality.planes() == 5);
  Quality cheapest(held("2"));
  CHECK(run(cheapest, 0.01, 30000) == 2);
}

TEST_CASE("Pressed planes are selected first, deepest first, then the nearest planes") {
  Surfaces surfaces(0, SurfaceLimits{});
  Proxy proxy;
  proxy.reset({0, 0, 0.001});
  // The first planes are far apart in height; the last one is pressed.
  std::vector<touch_plane_t> planes;
  for (int i = 0; i < 6; ++i) planes.push_back(plane(i, {0, 0, -0.01 * (6 - i)}, Vector3d::UnitZ()));
  planes.push_back(plane(7, Vector3d::Zero(), Vector3d::UnitZ()));
  const auto tick = [&](int ms, std::size_t max_planes) {
    const auto m = model(ms, planes);
    surfaces.step(&m, sync::sim_time(ms * kMs), proxy.position(), 1e-3, max_planes);
    proxy.step(surfaces.list(), {0, 0, -0.001}, 1e-3);
    std::vector<std::int64_t> ids;
    for (const Surface& s : surfaces.list()) ids.push_back(s.contact_id);
    return ids;
  };
  CHECK(tick(0, 8).size() == 7);
  CHECK(tick(1, 3) == std::vector<std::int64_t>{4, 5, 7});
  CHECK(tick(2, 1) == std::vector<std::int64_t>{7});
  CHECK(tick(3, 5) == std::vector<std::int64_t>{7, 2, 3, 4, 5});
  CHECK(proxy.position().z() == Approx(0).margin(1e-12));
}

TEST_CASE("The force in a corner is equal at each quality step") {
  Pressing pressing{.lean = 0.1};
  const Vector3d device(0.001, 0.001, 0.003);  // in contact with the floor and two walls, for a tool of 5 mm
  const Vector3d full = pressing.press(0, 200, device, 8);
  REQUIRE(full.norm() > 1);
  CHECK((pressing.press(200, 400, device, 5) - full).norm() < 1e-9);
  CHECK((pressing.press(400, 600, device, 3) - full).norm() < 1e-9);
  pressing.largest_step_N = 0;
  pressing.press(600, 800, device, 8);
  CHECK(pressing.largest_step_N < 1e-9);
}

TEST_CASE("The force changes within the recovery time when pressed planes are omitted") {
  Pressing pressing{.lean = 0};
  // Wedged: the pit is narrower than the tool, so all five planes are pressed.
  const Vector3d device(0.0005, 0.0003, 0.003);
  const Vector3d full = pressing.press(0, 300, device, 8);
  pressing.largest_step_N = 0;
  const Vector3d few = pressing.press(300, 400, device, 3);
  const Vector3d again = pressing.press(400, 700, device, 8);
  CAPTURE(full.transpose(), few.transpose(), again.transpose(), pressing.largest_step_N);
  CHECK((few - full).norm() > 0.2);  // the omitted planes matter,
  CHECK((again - full).norm() < 1e-3);
  // and the force changes no faster than walls may jump: 0.1 mm a tick at 1 N/mm, in two directions.
  CHECK(pressing.largest_step_N < 0.1 * std::sqrt(2) + 1e-6);
}
