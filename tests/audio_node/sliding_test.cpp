#include "audio_node/sliding.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "lcmtypes/vectors.h"
#include "tests/audio_node/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kRun = 1, kMs = 1'000'000;

// Of body 1 past body 0, which wears the map.
contact_t sliding(const Vector3d& velocity_m_s, double force_N, const Vector3d& place_body,
                  const Vector3d& normal = Vector3d::UnitZ()) {
  contact_t c{};
  c.contact_id = 5, c.body_a = 0, c.body_b = 1, c.material_a = 0, c.material_b = 1, c.tool = 0;
  c.normal = to_vec3f(normal);
  c.normal_force_N = static_cast<float>(force_N);
  c.sliding_velocity_m_s = to_vec3f(velocity_m_s);
  c.point_count = 1, c.points.resize(1);
  c.points[0].a_body_m = to_vec3f(place_body);
  return c;
}

// Turned by 90 degrees about z, so that +y of the world is +x of the board.
scene_t board(bool stands) {
  scene_t s{};
  s.listener = to_pose(Eigen::Isometry3d::Identity());
  s.bodies.resize(2), s.body_count = 2;
  s.bodies[0].is_static = stands ? 1 : 0, s.bodies[1].id = 1;
  s.bodies[0].pose = to_pose(Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ())));
  s.materials = {rough(), material_def_t{}}, s.material_count = 2;
  s.materials[1].friction_dynamic = 0.5;
  return s;
}

// How the board is turned, as the simulation tells it.
world_state_t told(std::int64_t ms, const Eigen::Quaterniond& orientation,
                   const Vector3d& spin_rad_s = Vector3d::Zero()) {
  world_state_t m{};
  m.header.run_id = kRun, m.header.incarnation = 7, m.header.seq = ms;
  m.header.sim_time_ns = m.header.publish_time_ns = ms * kMs;
  m.clock = {ms * kMs, ms * kMs, 1};
  m.rate_Hz = 60, m.pages = 1, m.count = 1;
  m.bodies.resize(1);
  m.bodies[0].orientation = to_quatf(orientation);
  m.bodies[0].angular_velocity_rad_s = to_vec3f(spin_rad_s);
  return m;
}

sync::SimTime sim_ms(std::int64_t ms) { return sync::sim_time(ms * kMs); }

Eigen::Quaterniond turn(double rad, const Vector3d& axis = Vector3d::UnitZ()) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, axis));
}

}  // namespace

TEST_CASE("Contacts that slide over a map are told with the place in it, and louder with the power of friction") {
  const scene_t scene = board(true);
  const sync::BodyHistory nobody(kRun);
  Sliding slides(scene, wavy_surfaces(), nobody, Settings{});
  const Vector3d place(0.005, 0.003, 0), velocity(0, 0.1, 0);
  const auto all = slides.scrapes({sliding(velocity, 2, place)}, sim_ms(0), at_ms(0), 0.001);
  CHECK(slides.any());
  REQUIRE(all.size() == 1);
  const Scrape s = all[0];
  CHECK(s.u == Approx(0.005 / kWave_m));
  CHECK(s.v == Approx(0.003 / kWave_m));
  CHECK(s.u_per_s == Approx(0.1 / kWave_m));
  CHECK(std::abs(s.v_per_s) < 1e-4);
  CHECK(s.along_u == Approx(1));
  CHECK(s.level == Approx(Settings{}.scrape_level * std::sqrt(0.5 * 2 * 0.1)));
  CHECK(slides.scrapes({sliding(velocity, 8, place)}, sim_ms(1), at_ms(1), 0.001)[0].level == Approx(2 * s.level));
  CHECK(slides.scrapes({sliding(0.001 * velocity, 8, place)}, sim_ms(2), at_ms(2), 0.001).empty());
  SECTION("where nothing has a map, nothing is heard") {
    Sliding silent(scene, std::make_shared<HeardSurfaces>(), nobody, Settings{});
    CHECK_FALSE(silent.any());
    CHECK(silent.scrapes({sliding(velocity, 2, place)}, sim_ms(0), at_ms(0), 0.001).empty());
  }
  SECTION("a friction map changes the level where it changes") {
    material_def_t m{};
    m.friction_size_u_m = m.friction_size_v_m = 0.4, m.friction_black = 0.25, m.friction_white = 4;
    auto surfaces = std::make_shared<HeardSurfaces>();
    surfaces->by_material.push_back(
        {nullptr, std::make_shared<const FrictionMap>(HeightMap{2, 2, 255, {0, 255, 0, 255}}, m)});
    Sliding both(scene, surfaces, nobody, Settings{});
    const Scrape black = both.scrapes({sliding(velocity, 2, {0.1, 0, 0})}, sim_ms(0), at_ms(0), 0.001)[0];
    const Scrape white = both.scrapes({sliding(velocity, 2, {0.3, 0, 0})}, sim_ms(1), at_ms(1), 0.001)[0];
    // Of a pair the root of 16 counts, and of power the root again.
    CHECK(white.level == Approx(2 * black.level));
    CHECK(black.relief == nullptr);
  }
}

TEST_CASE("A body that moves scrapes as it is turned just then, and is silent until that is known") {
  const scene_t scene = board(false);
  sync::BodyHistory bodies(kRun);
  Sliding slides(scene, wavy_surfaces(), bodies, Settings{});
  const auto of = [&](const contact_t& c) { return slides.scrapes({c}, sim_ms(500), at_ms(500), 0.001); };
  const contact_t along_y = sliding({0, 0.1, 0}, 2, {0.005, 0.003, 0});
  CHECK(of(along_y).empty());
  SECTION("about the normal") {
    bodies.push(told(500, turn(M_PI / 2)), at_ms(500));
    REQUIRE(of(along_y).size() == 1);
    CHECK(of(along_y)[0].along_u == Approx(1));
    SECTION("and when it has turned on, the way over the map has another direction") {
      bodies.push(told(600, turn(M_PI)), at_ms(600));
      const Scrape s = slides.scrapes({along_y}, sim_ms(600), at_ms(600), 0.001).at(0);
      CHECK(std::abs(s.along_u) < 1e-6);
      CHECK(s.along_v == Approx(-1));
    }
  }
  SECTION("onto another side, whose map has other axes") {
    // +y of the body is up, so u grows along its z, and its z is along -y of the world.
    bodies.push(told(500, turn(M_PI / 2, Vector3d::UnitX())), at_ms(500));
    const contact_t c = sliding({0, 0.1, 0}, 2, {0.003, 0.01, 0.005});
    REQUIRE(of(c).size() == 1);
    CHECK(of(c)[0].u == Approx(0.005 / kWave_m));
    CHECK(of(c)[0].v == Approx(0.003 / kWave_m));
    CHECK(of(c)[0].along_u == Approx(-1));
  }
  SECTION("or is the second of the two") {
    bodies.push(told(500, turn(M_PI / 2)), at_ms(500));
    contact_t c = along_y;
    std::swap(c.body_a, c.body_b), std::swap(c.material_a, c.material_b);
    std::swap(c.points[0].a_body_m, c.points[0].b_body_m);
    REQUIRE(of(c).size() == 1);
    CHECK(of(c)[0].along_u == Approx(-1));
    CHECK(of(c)[0].u == Approx(0.005 / kWave_m));
  }
}

TEST_CASE("A finger on a turning board goes over its map as fast as the places that are told") {
  // Two thirds of a turn a second under a finger that stays; the board is told of at 60 Hz, the finger at 1 kHz.
  const double spin_rad_s = 4, radius_m = 0.03;
  sync::BodyHistory bodies(kRun);
  Sliding slides(board(false), wavy_surfaces(), bodies, Settings{});
  double gone_u = 0, gone_v = 0, begin_u = 0, begin_v = 0;
  for (std::int64_t ms = 0; ms <= 500; ++ms) {
    const double rad = 1e-3 * spin_rad_s * static_cast<double>(ms);
    if (ms % 17 == 0) bodies.push(told(ms, turn(rad), {0, 0, spin_rad_s}), sync::host_time(ms * kMs));
    const Vector3d finger(radius_m, 0, 0), board = Vector3d(0, 0, spin_rad_s).cross(finger);
    const contact_t c = sliding(-board, 2, turn(rad).conjugate() * finger);
    const Scrape s = slides.scrapes({c}, sim_ms(ms), at_ms(static_cast<double>(ms)), 0.001).at(0);
    if (ms == 0) begin_u = s.u, begin_v = s.v;
    // By what was told of the velocity before; half a tick of a circle off, of 60 repetitions in all.
    REQUIRE(std::abs(begin_u + gone_u - s.u) < 0.06);
    REQUIRE(std::abs(begin_v + gone_v - s.v) < 0.06);
    gone_u += 1e-3 * s.u_per_s, gone_v += 1e-3 * s.v_per_s;
  }
}

TEST_CASE("Over a map that is told of at 60 Hz the way is steady, and a body's own edge goes over none") {
  sync::BodyHistory bodies(kRun);
  bodies.push(told(0, turn(0)), sync::host_time(0));
  Sliding slides(board(false), wavy_surfaces(), bodies, Settings{});
  const bool own_edge = GENERATE(false, true);
  const double speed_m_s = 0.2;
  Scrape s;
  for (std::int64_t ms = 0; ms < 500; ++ms) {
    const double told_m = own_edge ? 0.02 : 1e-3 * speed_m_s * static_cast<double>(ms - ms % 17);
    contact_t c = sliding({speed_m_s, 0, 0}, 2, {told_m, 0, 0});
    // The other corners of what lies there, and now and then another that is deepest.
    c.points.resize(2), c.point_count = 2;
    c.points[1].a_body_m = to_vec3f(Vector3d(told_m + 0.1, 0.05, 0));
    if (ms % 34 >= 17) std::swap(c.points[0], c.points[1]);
    s = slides.scrapes({c}, sim_ms(ms), at_ms(static_cast<double>(ms)), 0.001).at(0);
    if (!own_edge) {
      REQUIRE(s.u_per_s == Approx(speed_m_s / kWave_m).epsilon(0.01));
      REQUIRE(s.u == Approx(told_m / kWave_m).margin(1e-4));
    }
  }
  if (own_edge) {
    // What there was at first has gone: nine looks at it of 50 ms each.
    CHECK(std::abs(s.u_per_s) < 0.001 * speed_m_s / kWave_m);
    CHECK(s.level > 0);  // of the roughness
  }
}
