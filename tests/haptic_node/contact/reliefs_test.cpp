#include "haptic_node/contact/reliefs.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "tests/grey_png.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

constexpr double kWave_m = 0.02, kHigh_m = 0.001, kRadius_m = 0.005;

// Waves along u, 20 mm long and 1 mm high; a friction map of two halves along u, black then white.
std::shared_ptr<const SurfaceMaps> waves(double high_m = kHigh_m, double wave_m = kWave_m, bool friction = false) {
  HeightMap map{64, 4, 65535, {}};
  for (int i = 0; i < 64 * 4; ++i)
    map.levels.push_back(static_cast<std::uint16_t>(
        std::lround(65535 * (0.5 + 0.5 * std::sin(2 * std::numbers::pi * (i % 64 + 0.5) / 64)))));
  HeightMap halves{64, 4, 1, {}};
  for (int i = 0; i < 64 * 4; ++i) halves.levels.push_back(i % 64 >= 32);
  material_def_t m{};
  m.bump_size_u_m = m.bump_size_v_m = wave_m, m.bump_height_m = high_m;
  m.friction_size_u_m = m.friction_size_v_m = 0.1, m.friction_black = 0.25, m.friction_white = 2.25;
  auto maps = std::make_shared<SurfaceMaps>();
  maps->by_material.resize(1);
  if (high_m > 0) maps->by_material[0].relief = std::make_shared<const Relief>(make_relief(map, m));
  if (friction) maps->by_material[0].friction = std::make_shared<const FrictionMap>(halves, m);
  return maps;
}

double height(double u_m) { return kHigh_m * (0.5 + 0.5 * std::sin(2 * M_PI * u_m / kWave_m)); }
double slope(double u_m) { return kHigh_m * M_PI / kWave_m * std::cos(2 * M_PI * u_m / kWave_m); }

// The plane z = 0 of a body rotated about z by `turned`, at `origin`; its message holds the point nearest to x.
touch_plane_t mapped(std::int64_t id, const Vector3d& x, double turned = 0,
                     const Vector3d& origin = Vector3d::Zero(), double friction = 0) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(turned, Vector3d::UnitZ()).toRotationMatrix();
  touch_plane_t p = plane(id, {x.x(), x.y(), 0}, Vector3d::UnitZ(), friction);
  p.material = 0;
  p.point_body_m = to_vec3(turn.transpose() * (Vector3d(x.x(), x.y(), 0) - origin));
  p.normal_body = to_vec3f(Vector3d::UnitZ());
  p.bump_asset = 1;
  p.bump_u = to_vec3f(turn * Vector3d::UnitX());
  return p;
}

Settings settled(const std::string& bump) {
  Settings s;
  s.bump = bump;
  return s;
}

// Pressed 2 mm deep at one place until the force has settled.
Vector3d force_at(Bench& bench, const Vector3d& place, std::vector<touch_plane_t> planes, double& ms,
                  double* proxy_z_m = nullptr) {
  Vector3d force = Vector3d::Zero();
  touch_model_t m;
  for (int i = 0; i < 300; ++i, ms += 1) {
    m = model(ms, planes);
    const TickOutput& out = bench.tick(ms, place + Vector3d(0, 0, kRadius_m - 0.002), &m);
    force = out.force_N;
    if (proxy_z_m) *proxy_z_m = out.state.proxy.position_m.z;
  }
  return force;
}

}  // namespace

TEST_CASE("With the height method the surface has the height of its map, and the force keeps its direction") {
  Bench bench(settled("height"));
  bench.renderer.set_maps(waves());
  double ms = 0;
  for (const double x : {0.0, 0.004, 0.011, 0.017, -0.013}) {
    const Vector3d f = force_at(bench, {x, 0.003, 0}, {mapped(7, {x, 0.003, 0})}, ms);
    // 1 N/mm; one pixel is 1/64 of a wave, over which the spline loses (2 pi / 64)^2 / 4 of 1 mm / 2.
    CHECK(f.z() == Approx(1000 * (0.002 + height(x))).margin(0.003));
    CHECK(f.head<2>().norm() < 1e-9);
  }
}

TEST_CASE("With the normal method the surface stays flat, and the force tilts with the slope at constant size") {
  Bench bench(settled("normal"));
  bench.renderer.set_maps(waves());
  double ms = 0, proxy_z = 0;
  for (const double x : {0.0, 0.004, 0.011, 0.017, -0.013}) {
    const Vector3d f = force_at(bench, {x, 0.003, 0}, {mapped(7, {x, 0.003, 0})}, ms, &proxy_z);
    CHECK(f.norm() == Approx(2).epsilon(1e-3));
    CHECK(-f.x() / f.z() == Approx(slope(x)).margin(0.16 * 0.005));
    CHECK(std::abs(f.y()) < 1e-9);
    CHECK(proxy_z == Approx(kRadius_m).margin(1e-6));
  }
}

TEST_CASE("The map moves and rotates with its body") {
  const double turned = GENERATE(0.0, 0.7, 2.5, -1.9);
  const Vector3d origin(0.31, -0.2, 0);
  Bench bench(settled("normal"));
  bench.renderer.set_maps(waves());
  double ms = 0;
  const Vector3d u(std::cos(turned), std::sin(turned), 0), place = origin + 0.004 * u + 0.03 * u.unitOrthogonal();
  const double along_m = (place - origin).dot(u);
  // The message holds another point of the plane than the touched one.
  const Vector3d f = force_at(bench, place, {mapped(7, place + Vector3d(0.002, 0.003, 0), turned, origin)}, ms);
  CHECK(-f.dot(u) / f.z() == Approx(slope(along_m)).margin(0.16 * 0.005));
  CHECK(std::abs(f.cross(u).z()) < 1e-6);
}

TEST_CASE("Every touched plane has its own relief") {
  // Five floors at one height touched at once carry a fifth each, or a single one carries all: the force is the
  // same.
  Bench bench(settled("normal"));
  bench.renderer.set_maps(waves());
  double ms = 0;
  std::vector<touch_plane_t> planes;
  for (int i = 0; i < 5; ++i) planes.push_back(mapped(7 + i, {0.004, 0, 0}));
  const Vector3d f = force_at(bench, {0.004, 0, 0}, planes, ms);
  CHECK(-f.x() / f.z() == Approx(slope(0.004)).margin(0.16 * 0.005));
  SECTION("A floor and a wall bind together in a corner") {
    Bench corner(settled("normal"));
    corner.renderer.set_maps(waves());
    touch_plane_t wall = plane(20, {0.02, 0, 0}, -Vector3d::UnitX());
    wall.material = 0, wall.bump_asset = 1;
    wall.point_body_m = to_vec3(Vector3d(0.02, 0.003, 0.004)),
    wall.point_m = to_vec3(Vector3d(0.02, 0.003, 0.004));
    wall.normal_body = to_vec3f(-Vector3d::UnitX());
    wall.bump_u = to_vec3f(Vector3d::UnitY());  // a wall across x: (y, z)
    double t = 0;
    const Vector3d device(0.02 - kRadius_m + 0.001, 0.003, kRadius_m - 0.002);
    Vector3d force;
    touch_model_t m;
    for (int i = 0; i < 300; ++i, t += 1) {
      m = model(t, {mapped(7, {0.015, 0.003, 0}), wall});
      force = corner.tick(t, device, &m).force_N;
    }
    // 2 N on the floor at the touched place, x = 15 mm; 1 N on the wall at y = 3 mm.
    const double floor = std::atan(slope(0.02 - kRadius_m)), side = std::atan(slope(0.003));
    CHECK(force.z() == Approx(2 * std::cos(floor)).margin(0.005));
    CHECK(force.x() == Approx(-2 * std::sin(floor) - std::cos(side)).margin(0.005));
    CHECK(force.y() == Approx(-std::sin(side)).margin(0.005));
  }
}

TEST_CASE("A change of the method under pressure causes no jump of the force") {
  Settings s = settled("none");
  Bench bench(s);
  bench.renderer.set_maps(waves());
  double ms = 0;
  const Vector3d place(0.004, 0, 0);
  Vector3d last = force_at(bench, place, {mapped(7, place)}, ms);
  CHECK((last - Vector3d(0, 0, 2)).norm() < 1e-6);
  const std::string from = GENERATE("height", "normal", "both"), to = GENERATE("none", "height", "normal", "both");
  double worst = 0;
  touch_model_t m;
  const auto run = [&](const std::string& method) {
    s.bump = method;
    bench.renderer.change(s);
    for (int i = 0; i < 100; ++i, ms += 1) {
      m = model(ms, {mapped(7, place)});
      const Vector3d f = bench.tick(ms, place + Vector3d(0, 0, kRadius_m - 0.002), &m).force_N;
      worst = std::max(worst, (f - last).norm());
      last = f;
    }
  };
  run(from);
  run(to);
  const bool high = to == "height" || to == "both", leans = to == "normal" || to == "both";
  const double size = 2 + (high ? 1000 * height(0.004) : 0), angle = leans ? std::atan(slope(0.004)) : 0;
  CHECK((last - size * Vector3d(-std::sin(angle), 0, std::cos(angle))).norm() < 0.01);
  // At most 1 N from heights and 0.3 N from slopes in 15 ticks; twice that during two transitions.
  CHECK(worst < 2 * (1 + 0.3) / 15);
}

TEST_CASE("A map that is loaded late causes no jump of the force") {
  Bench bench(settled("both"));
  double ms = 0, worst = 0;
  const Vector3d place(0.004, 0, 0);
  Vector3d last = force_at(bench, place, {mapped(7, place)}, ms);
  CHECK((last - Vector3d(0, 0, 2)).norm() < 1e-6);
  bench.renderer.set_maps(waves());
  touch_model_t m;
  for (int i = 0; i < 100; ++i, ms += 1) {
    m = model(ms, {mapped(7, place)});
    const Vector3d f = bench.tick(ms, place + Vector3d(0, 0, kRadius_m - 0.002), &m).force_N;
    worst = std::max(worst, (f - last).norm());
    last = f;
  }
  CHECK(last.norm() > 2.5);
  CHECK(worst < 2 * (1 + 0.3) / 15);
}

TEST_CASE("The force tilts by at most the steepest rendered slope, and its limits hold") {
  HeightMap map{64, 64, 1, {}};
  for (int i = 0; i < 64 * 64; ++i) map.levels.push_back((i * 7919 / 64 + i) % 3 == 0);
  material_def_t m{};
  m.bump_size_u_m = m.bump_size_v_m = 0.001, m.bump_height_m = 0.1;  // walls of 100 mm, 1 mm apart
  auto maps = std::make_shared<SurfaceMaps>();
  maps->by_material.resize(1);
  maps->by_material[0].relief = std::make_shared<const Relief>(make_relief(map, m));
  const std::string method = GENERATE("normal", "height", "both");
  Settings s = settled(method);
  Bench bench(s);
  bench.renderer.set_maps(maps);
  Vector3d last = Vector3d::Zero();
  touch_model_t m_sent;
  for (int ms = 0; ms < 500; ++ms) {
    const Vector3d place(0.5e-3 * ms, 0.21e-3 * ms, 0);
    m_sent = model(ms, {mapped(7, place)});
    const Vector3d f = bench.tick(ms, place + Vector3d(0, 0, kRadius_m - 0.002), &m_sent).force_N;
    REQUIRE(f.norm() <= s.force_limit_N + 1e-9);
    REQUIRE(beyond_slew_N(f, last, s.slew_limit_N_s * 1e-3) <= 1e-9);
    // The slew limit delays the force; for a force below it:
    if (method == "normal") REQUIRE(f.head<2>().norm() <= f.z() * s.bump_steepest * (1 + 1e-6) + 1e-9);
    last = f;
  }
}

TEST_CASE("A new surface yields only when its relief is above the proxy") {
  const Vector3d place(0.005, 0, 0);  // the top of a wave, 1 mm high
  Settings s = settled("height");
  Bench bench(s);
  bench.renderer.set_maps(waves());
  touch_model_t m;
  const auto tick = [&](int ms, double under_m, bool with_relief) {
    // A distant wall keeps the touch model from being lost.
    m = model(ms, {plane(3, {-1, 0, 0}, Vector3d::UnitX())});
    if (with_relief) m.planes.push_back(mapped(7, place)), m.plane_count = 2;
    return bench.tick(ms, place + Vector3d(0, 0, kRadius_m - under_m), &m).force_N.z();
  };
  int ms = 0;
  SECTION("The tool is above the smooth surface and below the relief") {
    for (; ms < 100; ++ms) CHECK(tick(ms, -0.0003, false) == 0);
    double last = 0, worst = 0;
    for (; ms < 116; ++ms) {
      const double force = tick(ms, -0.0003, true);
      worst = std::max(worst, force - last);
      last = force;
    }
    // 0.7 mm of relief over the proxy in 15 ms, at 1 N/mm.
    CHECK(worst < 0.1 * 1.05);
    CHECK(worst < 0.7 / 5);
    CHECK(last == Approx(0.7).margin(0.003));
  }
  SECTION("A hand from outside feels the full relief from the first tick") {
    // The same force as on a smooth surface at that height.
    Bench smooth(s);
    touch_plane_t high = plane(7, {place.x(), 0, height(place.x())}, Vector3d::UnitZ());
    double worst = 0, force = 0;
    for (; ms < 200; ++ms) {
      const double under_m = -0.003 + 2e-5 * ms;
      force = tick(ms, under_m, ms >= 100);
      m.planes.back() = ms >= 100 ? high : m.planes.back();
      worst = std::max(
          worst, std::abs(force - smooth.tick(ms, place + Vector3d(0, 0, kRadius_m - under_m), &m).force_N.z()));
    }
    CHECK(force > 1.5);
    CHECK(worst < 0.003);
  }
}

TEST_CASE("With the height method the steepest rendered slope limits the rate of the force, not its final value") {
  // 6 mm high on waves of 20 mm: the slope is up to 0.94, of which 0.5 are rendered.
  Settings s = settled("height");
  s.bump_steepest = 0.5;
  s.force_limit_N = 30, s.slew_limit_N_s = 100000;
  s.energy_limit_J = 10;
  const double speed_m_s = GENERATE(0.05, 0.2, 0.5);
  CAPTURE(speed_m_s);
  Bench bench(s);
  bench.renderer.set_maps(waves(6 * kHigh_m));
  double last = 0, worst = 0, least = 1e9, most = 0;
  touch_model_t m;
  Vector3d at = Vector3d::Zero();
  int ms = 0;
  const auto tick = [&] {
    m = model(ms, {mapped(7, at)});
    const double force = bench.tick(ms, at + Vector3d(0, 0, kRadius_m - 0.002), &m).force_N.z();
    ++ms;
    return force;
  };
  for (int i = 0; i < 200; ++i) last = tick();
  for (int i = 0; i < static_cast<int>(0.2 / speed_m_s * 1000); ++i) {
    at.x() += speed_m_s * 1e-3;
    const double force = tick();
    worst = std::max(worst, std::abs(force - last));
    least = std::min(least, force), most = std::max(most, force);
    last = force;
  }
  // Half of the motion per tick, or 0.1 mm; at 1 N/mm.
  CHECK(worst < 1.001 * std::max(0.5 * speed_m_s, 0.1));
  // The waves remain perceptible, slow ones in full (0.1 mm a tick is a slope of 2 there).
  CHECK(most - least > (speed_m_s < 0.1 ? 5.8 : 2));
  for (int i = 0; i < 200; ++i) last = tick();
  CHECK(last == Approx(1000 * (0.002 + 6 * height(at.x()))).margin(0.02));
}

TEST_CASE("Harder pressure downhill than uphill gains at most the limits of energy and power") {
  // With `normal` the surface stores no energy: pressing 3 mm deeper over 12 mm of descent, wave after wave, would
  // give energy for ever.
  const auto stroke = [](const Settings& s) {
    Bench bench(s);
    bench.renderer.set_maps(waves(12 * kHigh_m, 2 * kWave_m));
    constexpr double kSpeed_m_s = 0.3, kTurn_m = 0.1, kPress_m_s = 0.3, kMaxHandSpeed_m_s = 0.5;
    Vector3d last_place(0, 0, kRadius_m), last_force = Vector3d::Zero();
    double given_J = 0, max_J = 0, x = 0, way = 1, press_m = 0;
    touch_model_t m;
    for (int ms = 0; ms < 4000; ++ms) {
      if (std::abs(x) > kTurn_m) way = x > 0 ? -1 : 1;
      x += way * kSpeed_m_s * 1e-3;
      const bool downhill = way * std::cos(M_PI * x / kWave_m) < 0;
      press_m += std::clamp((downhill ? 0.005 : 0.002) - press_m, -kPress_m_s * 1e-3, kPress_m_s * 1e-3);
      const Vector3d place(x, 0, kRadius_m - press_m);
      given_J += last_force.dot(place - last_place);
      max_J = std::max(max_J, given_J);
      last_place = place;
      m = model(ms, {mapped(7, {x, 0, 0})});
      const Vector3d f = bench.tick(ms, place, &m).force_N;
      REQUIRE(f.norm() <= s.force_limit_N + 1e-9);
      REQUIRE(beyond_slew_N(f, last_force, s.slew_limit_N_s * 1e-3) <= 1e-9);
      last_force = f;
      // As for false touch models (hostile_test.cpp): the energy that the force gives while it is reduced is
      // additional.
      const double drawn_back_s = s.force_limit_N / s.slew_limit_N_s + 0.002;
      REQUIRE(given_J <= s.energy_limit_J + s.power_limit_W * (ms + 1) * 1e-3 +
                             s.force_limit_N * kMaxHandSpeed_m_s * drawn_back_s);
    }
    return max_J;
  };
  Settings s = settled("normal");
  s.energy_limit_J = 0.05, s.power_limit_W = 0.01;
  const double limited_J = stroke(s);
  s.energy_limit_J = 10, s.power_limit_W = 50;
  CAPTURE(limited_J);
  CHECK(limited_J > 0.025);
  // Shows that the motion is hostile.
  CHECK(stroke(s) > 5 * 0.09);
}

TEST_CASE("A friction map scales the friction at the touched place") {
  const double x = GENERATE(0.025, 0.075);  // the middles of black and white
  Bench bench(settled("none"));
  bench.renderer.set_maps(waves(0, kWave_m, true));
  // Slides at 20 mm/s, 2 mm deep; the friction of the pair is 0.2.
  touch_model_t m;
  Vector3d f = Vector3d::Zero();
  for (int ms = 0; ms < 300; ++ms) {
    const Vector3d place(x + 0.02e-3 * (ms - 300), 0, 0);
    m = model(ms, {mapped(7, place, 0, Vector3d::Zero(), 0.2)});
    f = bench.tick(ms, place + Vector3d(0, 0, kRadius_m - 0.002), &m).force_N;
  }
  const double factor = x < 0.05 ? std::sqrt(0.25) : std::sqrt(2.25);
  CHECK(-f.x() / f.z() == Approx(0.2 * factor).epsilon(1e-3));
}

TEST_CASE("A plane with an invalid axis or without a material is smooth") {
  Bench bench(settled("both"));
  bench.renderer.set_maps(waves());
  touch_plane_t p = mapped(7, {0.004, 0, 0});
  const int wrong = GENERATE(0, 1, 2, 3, 4);
  if (wrong == 0) p.bump_u = {};
  if (wrong == 1) p.bump_u = to_vec3f(Vector3d::UnitZ());  // along the normal
  if (wrong == 2) p.material = -1;
  if (wrong == 3) p.material = 1000;  // of another scene
  if (wrong == 4) p.normal_body = {};
  double ms = 0;
  CHECK((force_at(bench, {0.004, 0, 0}, {p}, ms) - Vector3d(0, 0, 2)).norm() < 1e-6);
}

TEST_CASE("Maps are read from the pictures of the scene, and unreadable maps are reported") {
  scene_t s{};
  const std::vector<std::uint8_t> good = tactus::test::png_bytes(2, 2, 8, {0, 10, 20, 255}), bad{'x'};
  for (const auto& [bump, friction] : {std::pair<std::int64_t, std::int64_t>{1, 0}, {0, 1}, {1, 2}, {3, 0}}) {
    material_def_t m{};
    m.name = "m" + std::to_string(s.materials.size());
    m.bump_asset = bump, m.bump_size_u_m = m.bump_size_v_m = 0.1, m.bump_height_m = 0.001;
    m.friction_asset = friction, m.friction_size_u_m = m.friction_size_v_m = 0.1, m.friction_white = 1;
    s.materials.push_back(m);
  }
  const SurfaceMaps maps = read_maps(s, {{1, good}, {2, bad}});
  REQUIRE(maps.by_material.size() == 4);
  CHECK(maps.by_material[0].relief);
  CHECK(maps.by_material[0].relief == maps.by_material[2].relief);  // shared
  CHECK_FALSE(maps.by_material[0].friction);
  CHECK(maps.by_material[1].friction);
  CHECK_FALSE(maps.by_material[2].friction);
  CHECK_FALSE(maps.by_material[3].relief);
  CHECK(
      maps.error ==
      "the friction map of material m2 cannot be read: it is not a PNG file; the surface is rendered without it");
  CHECK(maps.find(-1) == nullptr);
  CHECK(maps.find(4) == nullptr);
}
