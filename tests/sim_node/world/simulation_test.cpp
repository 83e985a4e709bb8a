#include "sim_node/world/simulation.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/light_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/bus/identity.h"
#include "tests/sim_node/support/simple_hand.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

TEST_CASE("A tool that presses on the floor has begin and hit at contact and an end when it leaves") {
  WorldDef w = empty_world();
  add_floor(w);
  add_tool(w, {0, 0, 0.05});
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {0, 0, 0.05}};
  std::vector<contact_event_t> events;
  std::vector<float> forces;
  const double speed = 0.2371;
  const auto height = [&](double t) { return t < 0.3 ? 0.05 - speed * t : 0.05 - speed * 0.3 + speed * (t - 0.3); };
  std::int64_t contact = 0;
  for (int i = 0; i < 600; ++i) {
    const double t = sync::to_seconds(s.now().time_since_epoch());
    s.step(std::vector{hand.tick(s.touch_models()[0], {0, 0, height(t)}, sync::to_ns(s.now()))});
    for (const auto& e : s.events()) events.push_back(e);
    for (const auto& e : s.events()) CHECK(e.time_ns <= sync::to_ns(s.now()));
    if (s.touch_models()[0].plane_count > 0 && contact == 0) contact = s.touch_models()[0].planes[0].contact_id;
    for (const auto& c : s.tool_contacts()) forces.push_back(c.normal_force_N);
  }
  REQUIRE(events.size() == 3);
  CHECK(events[0].kind == contact_event_t::BEGIN);
  CHECK(events[1].kind == contact_event_t::HIT);
  CHECK(events[2].kind == contact_event_t::END);
  // The hand moves evenly and its samples carry their instants: the onset is exact within rounding to single
  // precision.
  const double met_s = (0.05 - 0.01) / speed;
  CHECK(events[1].time_ns * 1e-9 == Approx(met_s).margin(2e-5));
  CHECK(events[0].time_ns == events[1].time_ns);
  CHECK(events[1].approach_speed_m_s == Approx(speed).epsilon(1e-3));
  CHECK(events[1].effective_mass_kg == Approx(0.1));
  CHECK(events[1].curvature_1_m == Approx(100));
  CHECK(events[1].tool == 0);
  CHECK(events[1].normal.z == Approx(1));
  // It leaves on the way up, once it is the end gap away.
  CHECK(events[2].time_ns * 1e-9 == Approx(0.6 - met_s).margin(0.003));
  // The plane has the contact id before the touch.
  CHECK(contact == events[0].contact_id);
  // The next touch is another contact.
  REQUIRE(s.touch_models()[0].plane_count == 0);
  CHECK(*std::max_element(forces.begin(), forces.end()) == Approx(1000 * (0.3 * speed - 0.04)).epsilon(0.05));
}

TEST_CASE("The push on a free ball equals the force on the hand, and momentum is conserved") {
  WorldDef w = empty_world(0);
  const int ball = add_ball(w, 0.3, 0.05, {0, 0, 0});
  add_tool(w, {-0.1, 0, 0});
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .stiffness = 500, .last = {-0.1, 0, 0}};
  bool begun = false;
  for (int i = 0; i < 500; ++i) {
    const double t = sync::to_seconds(s.now().time_since_epoch());
    // Approaches, pushes, and stops well before the ball is out of reach.
    const double x = t < 0.25 ? -0.1 + 0.3 * t : -0.1 + 0.3 * 0.25;
    s.step(std::vector{hand.tick(s.touch_models()[0], {x, 0, 0}, sync::to_ns(s.now()))});
    for (const auto& e : s.events()) begun |= e.kind == contact_event_t::BEGIN;
  }
  CHECK(begun);
  Vector3d felt = Vector3d::Zero();
  for (const auto& [id, impulse] : hand.impulses) felt += to_eigen(to_vec3f(impulse));
  const Vector3d momentum = 0.3 * s.bodies()[static_cast<std::size_t>(ball)].velocity_m_s;
  CHECK(momentum.x() > 0.03);
  CHECK((momentum + felt).norm() < 1e-3 * momentum.norm());
}

TEST_CASE("A corner has two planes, each with a constant id") {
  WorldDef w = empty_world();
  add_floor(w);
  const int wall = add_body(w, "wall", 0, Eigen::Matrix3d::Identity(), at(0.1, 0, 0.5));
  add_shape(w, wall, ShapeKind::kBox, {0.1, 1, 1});
  add_tool(w, {0.035, 0, 0.014});
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {0.035, 0, 0.014}};
  std::set<std::int64_t> names;
  for (int i = 0; i < 200; ++i) {
    s.step(std::vector{hand.tick(s.touch_models()[0], {0.035 + 1e-5 * i, 1e-4 * i, 0.014}, sync::to_ns(s.now()))});
    const touch_model_t& m = s.touch_models()[0];
    REQUIRE(m.plane_count == 2);
    for (const touch_plane_t& p : m.planes) {
      names.insert(p.contact_id);
      CHECK(p.effective_mass_kg >= 1e9f);
      const bool is_wall = p.body == wall;
      CHECK((is_wall ? -p.normal.x : p.normal.z) == Approx(1));
      CHECK((is_wall ? p.point_m.x : p.point_m.z) == Approx(is_wall ? 0.05 : 0).margin(1e-12));
    }
  }
  CHECK(names.size() == 2);
}

TEST_CASE("A plane names the height map of its surface and its projection axis in the world") {
  WorldDef w = empty_world(0);
  material_def_t planks{};
  planks.youngs_modulus_Pa = 1e10, planks.poissons_ratio = 0.3, planks.friction_static = planks.friction_dynamic = 0.5;
  w.materials = {planks, planks};
  w.materials[1].bump_asset = 77;
  // Turned, so that the body and world frames differ.
  const Eigen::Isometry3d pose(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.9, Vector3d(1, 2, 3).normalized()));
  const int box = add_body(w, "box", 0, Eigen::Matrix3d::Identity(), pose);
  const auto shape = static_cast<std::size_t>(add_shape(w, box, ShapeKind::kBox, {0.2, 0.2, 0.2}));
  w.shapes[shape].material = 1;
  const int across = GENERATE(0, 1, 2), sign = GENERATE(-1, 1);
  add_tool(w, pose * Vector3d(sign * 0.105 * Vector3d::Unit(across)), 0.004);
  const auto plane = [&] {
    Simulation s(w, {});
    s.start(11);
    s.step({});
    REQUIRE(s.touch_models()[0].plane_count == 1);
    return s.touch_models()[0].planes[0];
  };
  CHECK((to_eigen(plane().normal_body) - sign * Vector3d::Unit(across)).norm() < 1e-6);
  CHECK(plane().bump_asset == 77);
  const Vector3d u = pose.linear() * Vector3d::Unit((across + 1) % 3);
  CHECK((to_eigen(plane().bump_u) - u).norm() < 1e-6);
  SECTION("a surface with only a friction map has one too") {
    w.materials[1].bump_asset = 0, w.materials[1].friction_asset = 78;
    CHECK(plane().bump_asset == 0);
    CHECK((to_eigen(plane().bump_u) - u).norm() < 1e-6);
  }
  SECTION("a smooth surface has none") {
    w.shapes[shape].material = 0;
    CHECK(plane().bump_asset == 0);
    CHECK(to_eigen(plane().bump_u) == Vector3d(0, 0, 0));
    w.shapes[shape].material = -1;
    CHECK(plane().bump_asset == 0);
  }
}

TEST_CASE("A tool among many bodies has the nearest 49 planes in order") {
  WorldDef w = empty_world(0);
  for (int i = 0; i < 60; ++i) {
    const double phi = 0.7 * i, z = -0.9 + 0.03 * i, r = std::sqrt(1 - z * z);
    add_ball(w, 1, 0.004, (0.018 + 1e-5 * i) * Vector3d(r * std::cos(phi), r * std::sin(phi), z));
  }
  add_tool(w, {0, 0, 0});
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {0, 0, 0}};
  s.step(std::vector{hand.tick(s.touch_models()[0], {0, 0, 0}, 0)});
  const touch_model_t& m = s.touch_models()[0];
  REQUIRE(m.plane_count == 49);
  double last = -1;
  for (const touch_plane_t& p : m.planes) {
    const double gap = to_eigen(p.point_m).norm();
    CHECK(gap >= last - 1e-12);
    last = gap;
  }
}

TEST_CASE("Bodies at rest at the start begin their contacts, and a silent tool touches nothing") {
  WorldDef w = empty_world();
  add_floor(w);
  add_ball(w, 0.2, 0.03, {0.5, 0, 0.0299});
  add_tool(w, {0, 0, 0.0095});
  Simulation s(w, {});
  s.start(11);
  s.step({});
  REQUIRE(s.events().size() == 1);
  CHECK(s.events()[0].kind == contact_event_t::BEGIN);
  CHECK(s.tool_contacts().empty());
  Hand hand{.radius = 0.01, .last = {0, 0, 0.0095}};
  s.step(std::vector{hand.tick(s.touch_models()[0], {0, 0, 0.0095}, sync::to_ns(s.now()))});
  CHECK(s.tool_contacts().size() == 1);
  int ends = 0;
  for (int i = 0; i < 60; ++i) {
    s.step({});
    for (const auto& e : s.events()) ends += e.kind == contact_event_t::END;
  }
  CHECK(ends == 1);
  CHECK(s.tool_contacts().empty());
}

TEST_CASE("The same messages give a bit-identical world") {
  const auto digest = [] {
    WorldDef w = empty_world();
    add_floor(w);
    for (int i = 0; i < 6; ++i) add_box(w, 0.2, {0.05, 0.05, 0.05}, at(0, 0, 0.026 + 0.051 * i));
    add_tool(w, {-0.1, 0, 0.07});
    Simulation s(w, {});
    s.start(11);
    Hand hand{.radius = 0.01, .last = {-0.1, 0, 0.07}};
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 700; ++i) {
      s.step(std::vector{hand.tick(s.touch_models()[0], {-0.1 + 2e-4 * i, 0, 0.07}, sync::to_ns(s.now()))});
      touch_model_t& m = s.touch_models()[0];
      std::vector<std::uint8_t> one(static_cast<std::size_t>(m.getEncodedSize()));
      m.encode(one.data(), 0, m.getEncodedSize());
      bytes.insert(bytes.end(), one.begin(), one.end());
      for (const BodyMotion& b : s.bodies()) {
        const auto* p = reinterpret_cast<const std::uint8_t*>(b.position_m.data());
        bytes.insert(bytes.end(), p, p + 24);
      }
      for (const auto& e : s.events()) bytes.push_back(static_cast<std::uint8_t>(e.time_ns));
    }
    return sync::fnv1a_64(bytes.data(), bytes.size());
  };
  CHECK(digest() == digest());
}

TEST_CASE("A tool with the name of a spot light touches nothing") {
  WorldDef w = empty_world();
  add_floor(w);
  add_tool(w, {0, 0, 0.05});
  w.lights.resize(1);
  w.lights[0].name = w.tools[0].name;
  w.lights[0].kind = light_def_t::SPOT;
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {0, 0, 0.05}};
  for (int i = 0; i < 300; ++i) {
    s.step(std::vector{hand.tick(s.touch_models()[0], {0, 0, 0.05 - 0.001 * i}, sync::to_ns(s.now()))});
    CHECK(s.touch_models()[0].tool == -1);  // is not published
    CHECK(s.touch_models()[0].planes.empty());
    CHECK(s.events().empty());
  }
  CHECK(s.bodies().back().position_m.z() == Approx(0.05 - 0.298));  // as in the message of the previous step
  w.lights[0].kind = light_def_t::POINT;
  WorldDef with_head = w;
  with_head.tools[0].name = "head";
  Simulation sees(with_head, {});
  sees.start(11);
  CHECK(sees.touch_models()[0].tool == -1);
  Simulation touches(w, {});
  touches.start(11);
  CHECK(touches.touch_models()[0].tool == 0);
}
