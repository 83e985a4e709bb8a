// The touch model of a tool that renders it late: fixed surfaces are in it from further away.
#include "sim_node/touch/tool_touch.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/model/triangles.h"
#include "sync/resampling/sample_status.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/simple_hand.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;
using sync::SampleStatus;

namespace {

// The touch model of the tool of a world that stands still. Each look is a step of 1 ms.
struct Bench {
  explicit Bench(const WorldDef& def) : world(def), touch(world, 0, Settings{}, ids, trees) {
    for (const BodyDef& b : world.bodies) {
      BodyMotion m;
      m.position_m = m.centre_m = b.pose.translation();
      m.orientation = Eigen::Quaterniond(b.pose.linear());
      m.inverse_mass_1_kg = b.is_static ? 0 : 1;
      bodies.push_back(m);
    }
  }
  const touch_model_t& at(const Vector3d& place, SampleStatus status, const Vector3d& velocity_m_s = {0, 0, 0}) {
    tool_state_t m{};
    m.header.sim_time_ns = sync::to_ns(now);
    m.device.position_m = m.proxy.position_m = to_vec3(place);
    m.device.orientation.w = m.proxy.orientation.w = 1;
    m.device_velocity_m_s = to_vec3f(velocity_m_s);
    m.touch_status = static_cast<std::int8_t>(status);
    std::vector<contact_event_t> events;
    touch.update(now, bodies, std::vector{m}, events);
    now += sync::Nanoseconds(1'000'000);
    return touch.model();
  }

  WorldDef world;
  MeshTrees trees;
  Ids ids{1};
  ToolTouch touch;
  std::vector<BodyMotion> bodies;
  sync::SimTime now = sync::sim_time(0);
};

constexpr double kRadius_m = 0.01;  // of the tool of add_tool()

}  // namespace

TEST_CASE("A tool that renders a late model has the fixed surfaces within 0.1 m in it, and no movable ones") {
  WorldDef w = empty_world();
  const int floor = add_floor(w);
  add_ball(w, 0.2, 0.01, {0.05, 0, 0.08});
  add_tool(w, {0, 0, 0.08});
  Bench bench(w);
  const Vector3d place(0, 0, 0.08);
  CHECK(bench.at(place, SampleStatus::kNone).plane_count == 0);
  CHECK(bench.at(place, SampleStatus::kExtrapolated).plane_count == 0);
  for (const SampleStatus late : {SampleStatus::kHeld, SampleStatus::kStale}) {
    const touch_model_t& m = bench.at(place, late);
    REQUIRE(m.plane_count == 1);
    CHECK(m.planes[0].body == floor);
    CHECK(m.planes[0].effective_mass_kg >= 1e9f);
    CHECK(m.planes[0].point_m.z == 0);
    CHECK(m.planes[0].normal.z == 1);
  }
  CHECK(bench.at({0, 0, 0.111}, SampleStatus::kHeld).plane_count == 0);
  // Losses in bursts: the tool counts as late for a second after the last late model.
  CHECK(bench.at(place, SampleStatus::kExact).plane_count == 1);
  bench.now += sync::Nanoseconds(1'000'000'000);
  CHECK(bench.at(place, SampleStatus::kExact).plane_count == 0);
}

TEST_CASE("A fixed surface keeps its contact id from afar until it is touched") {
  WorldDef w = empty_world();
  add_floor(w);
  add_tool(w, {0, 0, 0.1});
  Bench bench(w);
  std::int64_t id = 0;
  for (int k = 0; k <= 90; ++k) {
    const touch_model_t& m = bench.at({0, 0, 0.1 - 0.001 * k}, SampleStatus::kHeld);
    REQUIRE(m.plane_count == 1);
    if (id == 0) id = m.planes[0].contact_id;
    CHECK(m.planes[0].contact_id == id);
  }
}

TEST_CASE("Far fixed surfaces fill at most one page and take no place of a nearer surface") {
  WorldDef w = empty_world(0);
  for (int i = 0; i < 40; ++i)
    add_ball(w, 0, 0.004, 0.05 * Vector3d(std::cos(0.7 * i), std::sin(0.7 * i), 0.05 * i - 1).normalized());
  const int near = GENERATE(0, 5, 12);
  for (int i = 0; i < near; ++i) add_ball(w, 1, 0.002, 0.015 * Vector3d(std::cos(0.5 * i), std::sin(0.5 * i), 0));
  add_tool(w, {0, 0, 0});
  Bench bench(w);
  const int fresh = bench.at({0, 0, 0}, SampleStatus::kExact).plane_count;
  const touch_model_t& m = bench.at({0, 0, 0}, SampleStatus::kHeld);
  CHECK(fresh == near);
  CHECK(m.plane_count == std::max(7, near));
  for (int i = 0; i < near; ++i) CHECK(m.planes[static_cast<std::size_t>(i)].body >= 40);
}

TEST_CASE("The near surfaces of a tool are the same whether it renders a late model or not") {
  Random random(30);
  WorldDef w = empty_world(0);
  const Soup soup = lumpy_sphere(3, 0.02, 1);
  TriangleMesh mesh{soup.vertices, {}, soup.indices};
  complete_normals(mesh);
  w.meshes.push_back(mesh);
  const auto place = [&] {
    return Vector3d(uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1));
  };
  for (int i = 0; i < 12; ++i) {
    const Vector3d p = place();
    const int body = add_body(w, "thing", i % 3 == 0 ? 1 : 0, Eigen::Matrix3d::Identity(), at(p.x(), p.y(), p.z()));
    if (i % 2 == 0)
      add_shape(w, body, ShapeKind::kBox, {0.02, 0.03, 0.04});
    else
      w.shapes[static_cast<std::size_t>(add_shape(w, body, ShapeKind::kMesh, {1, 1, 1}))].mesh = 0;
  }
  add_tool(w, {0, 0, 0});
  Bench fresh(w), late(w);
  for (int round = 0; round < 300; ++round) {
    const Vector3d p = place(), v(0.3, 0, 0);
    const double margin_m = kRadius_m + 0.008 + (round > 0 ? 0.03 * v.norm() : 0);  // of the settings
    const auto near = [&](const touch_model_t& m) {
      std::vector<Vector3d> points;
      for (const touch_plane_t& plane : m.planes)
        if ((to_eigen(plane.point_m) - p).norm() <= margin_m - 1e-9) points.push_back(to_eigen(plane.point_m));
      return points;
    };
    CAPTURE(round);
    const auto expected = near(fresh.at(p, SampleStatus::kExact, v));
    CHECK(near(late.at(p, SampleStatus::kHeld, v)) == expected);
  }
}

TEST_CASE("Places 300 km from the origin are exact in the touch model, the contacts and the events of a tool") {
  WorldDef w = empty_world();
  add_floor(w);
  const Vector3d place(3e5 + 0.0123, -2e5 - 0.0321, kRadius_m), below(place.x(), place.y(), 0);
  add_tool(w, place);
  Bench bench(w);
  tool_state_t m{};
  m.device.position_m = m.proxy.position_m = to_vec3(place);
  m.device.orientation.w = m.proxy.orientation.w = 1;
  std::vector<contact_event_t> events;
  bench.touch.update(bench.now, bench.bodies, std::vector{m}, events);
  REQUIRE(bench.touch.model().plane_count == 1);
  const touch_plane_t& plane = bench.touch.model().planes[0];
  CHECK((to_eigen(plane.point_m) - below).norm() < 1e-9);
  CHECK((to_eigen(plane.point_body_m) - below).norm() < 1e-9);
  REQUIRE(events.size() == 1);
  CHECK((to_eigen(events[0].point_m) - below).norm() < 1e-9);
  std::vector<contact_t> contacts;
  bench.touch.describe(bench.bodies, contacts);
  REQUIRE(contacts.size() == 1);
  for (const vec3_t& p : {contacts[0].points[0].a_world_m, contacts[0].points[0].b_world_m, contacts[0].points[0].a_body_m})
    CHECK((to_eigen(p) - below).norm() < 1e-9);
}
