#include "sim_node/contacts/contact_finder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "tests/sim_node/support/detectors.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// Initial motions of the bodies of a world, at rest unless set.
std::vector<BodyMotion> motions(const WorldDef& w) {
  std::vector<BodyMotion> out;
  for (const BodyDef& b : w.bodies) {
    BodyMotion m;
    m.position_m = b.pose.translation();
    m.orientation = Eigen::Quaterniond(b.pose.linear());
    m.centre_m = b.pose * b.centre_of_mass_m;
    m.velocity_m_s = b.velocity_m_s;
    if (!b.is_static) m.inverse_mass_1_kg = 1 / b.mass_kg;
    out.push_back(m);
  }
  return out;
}

std::vector<int> moving(const WorldDef& w) {
  std::vector<int> out;
  for (int i = 0; i < static_cast<int>(w.bodies.size()); ++i)
    if (!w.bodies[static_cast<std::size_t>(i)].is_static) out.push_back(i);
  return out;
}

std::vector<Manifold> contacts(const WorldDef& w, double h = kStep) {
  ContactFinder finder(w, Settings{});
  std::vector<Manifold> out;
  finder.find(motions(w), moving(w), h, out);
  return out;
}

double min_gap(const Manifold& m) {
  double gap = 1e300;
  for (const ManifoldPoint& p : m.used()) gap = std::min(gap, -p.depth_m);
  return gap;
}

TriangleMesh mesh_of(const Soup& s) { return {s.vertices, {}, s.indices}; }

}  // namespace

TEST_CASE("A contact finder rejects detectors that report no gaps") {
  WorldDef w = empty_world();
  add_floor(w);
  add_ball(w, 1, 0.05, {0, 0, 0.0501});
  for (const std::string_view name : kDetectors) {
    INFO(name);
    Settings s;
    s.detector = name;
    if (make_detector(name)->abilities().separation)
      CHECK_NOTHROW(ContactFinder(w, s));
    else
      CHECK_THROWS_WITH(ContactFinder(w, s), Catch::Contains(s.detector) && Catch::Contains("reports no gaps"));
  }
}

TEST_CASE("A box tilted by one degree has contacts at all lower corners that may land in the step") {
  WorldDef w = empty_world();
  add_floor(w);
  const double edge = 0.1, tilt = M_PI / 180;
  Isometry3d pose = at(0, 0, 0.001 + edge / 2 * (std::cos(tilt) + std::sin(tilt)));
  pose.rotate(Eigen::AngleAxisd(tilt, Vector3d::UnitX()));
  const int body = add_box(w, 1, {edge, edge, edge}, pose);
  CHECK(contacts(w).empty());
  w.bodies[static_cast<std::size_t>(body)].velocity_m_s = {0, 0, -3};
  const auto found = contacts(w);
  REQUIRE(found.size() == 1);
  CHECK(found[0].count == 4);
  CHECK(min_gap(found[0]) == Approx(0.001).epsilon(1e-9));
}

TEST_CASE("Contacts of a ball with each shape are found within the motion of one step") {
  const double r = 0.03, speed = 20;
  const auto kind = GENERATE(ShapeKind::kPlane, ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder,
                             ShapeKind::kCapsule, ShapeKind::kMesh);
  const double gap = GENERATE(-0.001, 0.0003, 0.015, 0.019, 0.022);
  WorldDef w = empty_world();
  w.meshes.push_back(mesh_of(box({0.2, 0.2, 0.1})));
  const int under = add_body(w, "under", 0, Eigen::Matrix3d::Identity(), at(0, 0, 0));
  const bool sphere = kind == ShapeKind::kSphere;
  const int shape = add_shape(w, under, kind, sphere ? Vector3d(0.05, 0, 0) : Vector3d(0.05, 0.2, 0.1));
  w.shapes[static_cast<std::size_t>(shape)].mesh = 0;
  const double top = kind == ShapeKind::kPlane ? 0 : kind == ShapeKind::kCapsule ? 0.1 : 0.05;
  add_ball(w, 1, r, {0, 0, top + r + gap});
  w.bodies[1].velocity_m_s = {0, 0, -speed};
  const auto found = contacts(w);
  INFO("kind " << static_cast<int>(kind) << " gap " << gap);
  if (gap > speed * kStep + 1e-3) {
    CHECK(found.empty());
    return;
  }
  REQUIRE(found.size() == 1);
  CHECK(found[0].body_a == 0);
  CHECK(found[0].body_b == 1);
  CHECK(min_gap(found[0]) == Approx(gap).margin(1e-9));
  CHECK(found[0].points[0].normal.z() == Approx(1));
}

TEST_CASE("Inactive bodies have no contacts, and static bodies have none with each other") {
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < 3; ++i) add_box(w, 1, {0.1, 0.1, 0.1}, at(0, 0, 0.05 + 0.1 * i));
  ContactFinder finder(w, Settings{});
  std::vector<Manifold> out;
  const auto all = motions(w);
  finder.find(all, std::vector<int>{1, 2, 3}, kStep, out);
  REQUIRE(out.size() == 3);
  CHECK((out[0].shape_a == 0 && out[1].shape_a == 1 && out[2].shape_a == 2));
  for (const Manifold& m : out) CHECK(m.count == 4);
  finder.find(all, std::vector<int>{1, 3}, kStep, out);
  CHECK(out.size() == 1);
  finder.find(all, std::vector<int>{3}, kStep, out);
  CHECK(out.empty());
}

TEST_CASE("Contacts include bodies that an impact reaches through a row within the step") {
  WorldDef w = empty_world(0);
  const double r = 0.02, gap = 0.004, e = GENERATE(0.0, 1.0);
  for (int i = 0; i < 5; ++i) add_ball(w, 1, r, {i * (2 * r + gap), 0, 0}, 0.5, e);
  CHECK(contacts(w).empty());
  w.bodies[0].velocity_m_s = {20, 0, 0};
  const auto found = contacts(w);
  // 20 mm of travel for 4 mm of gaps: without loss the last body is hit too; with half of the speed lost at each
  // impact, two gaps close.
  CHECK(found.size() >= (e > 0 ? 4u : 2u));
  for (const Manifold& m : found)
    if (m.body_b == m.body_a + 1) CHECK(min_gap(m) == Approx(gap));
}

TEST_CASE("A body that bounces off the floor has contacts with the body above") {
  WorldDef w = empty_world(0);
  add_floor(w, 0.5, 1);
  add_ball(w, 1, 0.02, {0, 0, 0.022}, 0.5, 1);
  add_ball(w, 1, 0.02, {0, 0, 0.067}, 0.5, 1);
  w.bodies[1].velocity_m_s = {0, 0, -20};
  const auto found = contacts(w);
  CHECK(std::any_of(found.begin(), found.end(), [](const Manifold& m) { return m.body_a == 1 && m.body_b == 2; }));
}

TEST_CASE("A body that floor friction accelerates has contacts with the body beside it") {
  WorldDef w = empty_world(0);
  add_floor(w, 1, 0.5);
  add_ball(w, 1, 0.02, {0, 0, 0.022}, 1, 0.5);
  add_ball(w, 1, 0.02, {0.05, 0, 0.02}, 1, 0.5);
  w.bodies[1].velocity_m_s = {0, 0, -20};
  const auto found = contacts(w);
  CHECK(std::any_of(found.begin(), found.end(), [](const Manifold& m) { return m.body_a == 1 && m.body_b == 2; }));
}

TEST_CASE("A body that rolls past others has no contact with them") {
  WorldDef w = empty_world();
  add_floor(w);
  const double h = 1.0 / 60, speed = 0.2, gap = GENERATE(0.003, 0.005);
  for (const double y : {0.0, 0.04 + gap}) add_ball(w, 1, 0.02, {0, y, 0.02});
  for (const std::size_t i : {1u, 2u}) w.bodies[i].velocity_m_s = {speed, 0, 0};
  std::vector<BodyMotion> rolling = motions(w);
  for (const std::size_t i : {1u, 2u}) rolling[i].spin_rad_s = {0, speed / 0.02, 0};
  ContactFinder finder(w, Settings{});
  std::vector<Manifold> found;
  finder.find(rolling, moving(w), h, found);
  // In any direction: the effect of gravity on a gap, and the tolerance.
  CHECK(found.size() == (gap < kG * h * h + Settings{}.contact_tolerance_m ? 3u : 2u));
}

TEST_CASE("Contacts of a pair do not depend on other bodies or earlier queries") {
  Random random(17);
  WorldDef w = empty_world();
  w.meshes = {mesh_of(lumpy_sphere(2, 0.05, 4))};
  add_floor(w);
  const ShapeKind kinds[] = {ShapeKind::kBox,     ShapeKind::kSphere, ShapeKind::kCylinder,
                             ShapeKind::kCapsule, ShapeKind::kMesh,   ShapeKind::kPlane};
  for (int i = 0; i < 60; ++i) {
    Isometry3d pose = random_pose(random, 0);
    pose.pretranslate(Vector3d(uniform(random, 0, 0.5), uniform(random, 0, 0.5), uniform(random, 0, 0.3)));
    const int body = add_body(w, "thing", i % 7 == 0 ? 0 : 1, Eigen::Matrix3d::Identity(), pose);
    w.bodies.back().velocity_m_s = uniform(random, 0, 3) * direction(random);
    const int shape = add_shape(w, body, kinds[i % 6], {0.05, 0.06, 0.08});
    w.shapes[static_cast<std::size_t>(shape)].mesh = 0;
  }
  const auto all = motions(w);
  const auto active = moving(w);
  const auto same = [](const std::vector<Manifold>& x, const std::vector<Manifold>& y) {
    if (x.size() != y.size()) return false;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (x[i].shape_a != y[i].shape_a || x[i].shape_b != y[i].shape_b || x[i].count != y[i].count) return false;
      for (int k = 0; k < x[i].count; ++k) {
        const ManifoldPoint &p = x[i].points[static_cast<std::size_t>(k)],
                            &q = y[i].points[static_cast<std::size_t>(k)];
        if (p.point_m != q.point_m || p.normal != q.normal || p.depth_m != q.depth_m) return false;
      }
    }
    return true;
  };
  ContactFinder one(w, Settings{}), other(w, Settings{});
  std::vector<Manifold> found, again, few;
  one.find(all, active, kStep, found);
  REQUIRE(found.size() > 30);
  for (std::size_t i = 1; i < found.size(); ++i) CHECK(found[i - 1].before(found[i]));
  for (const Manifold& m : found) CHECK(m.body_a < m.body_b);
  other.find(all, std::vector<int>(active.begin(), active.begin() + 20), 1.0 / 60, few);
  other.find(all, active, kStep, again);
  CHECK(same(found, again));
}
