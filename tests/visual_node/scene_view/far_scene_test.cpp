// A scene far from the origin of the world is drawn like the same scene at the origin.
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <utility>

#include "lcmtypes/bump.h"
#include "tests/visual_node/support/test_scene.h"
#include "visual_node/overlay/contact_strokes.h"
#include "visual_node/overlay/picking.h"
#include "visual_node/scene_view/flashes.h"
#include "visual_node/scene_view/repeated_place.h"
#include "visual_node/scene_view/scene_view.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;
using Eigen::Vector3d;

namespace {

// Whole cells of the grid of origins, so that the places about the origin are the same.
const Vector3d kFar(64 * 4687, -64 * 3125, 64 * 1562);

scene_t lit_room(const Vector3d& shift) {
  scene_t scene = empty_scene();
  const auto put = [&](const Vector3d& at_m) { return Vector3d(shift + at_m); };
  add_visual(scene, add_body(scene, put({0, 0, 0})), shape_def_t::PLANE, {10, 10, 0});
  add_visual(scene, add_body(scene, put({0.0123, -0.5, 0.1})), shape_def_t::BOX, {0.2, 0.2, 0.2});
  add_visual(scene, add_body(scene, put({1.234, 0.567, 0.05})), shape_def_t::SPHERE, {0.05, 0, 0});
  scene.camera = to_pose(Eigen::Isometry3d(Eigen::Translation3d(put({0.1, 0.2, 2})) *
                                           Eigen::AngleAxisd(std::acos(0.0), Vector3d::UnitY())));
  scene.lights = {spot(put({0.7, 0, 2}), 0.6, 1.0), spot(put({-1, 1, 3}), 0.6, 1.0)};
  scene.lights[0].name = "lamp";
  add_tool(scene, 0.005);
  scene.tools[0].name = "lamp";
  return scene;
}

DrawList drawn(const Vector3d& shift, const std::string& stereo) {
  const scene_t scene = lit_room(shift);
  Settings settings;
  settings.stereo = stereo;
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
  std::vector<ToolPose> tools(1);
  tools[0].known = true;
  tools[0].device.translation() = tools[0].proxy.translation() = shift + Vector3d(0.3, 0.1, 0);
  return SceneView(scene, {}, settings).draw(poses, tools);
}

}  // namespace

TEST_CASE("Shapes, lamps, shadows and views 300 km from the origin are drawn as at the origin") {
  for (const char* stereo : {"off", "side_by_side"}) {
    const DrawList here = drawn(Vector3d::Zero(), stereo), there = drawn(kFar, stereo);
    CHECK(here.camera.origin_m.isZero(0));
    CHECK(there.camera.origin_m == kFar);
    REQUIRE(here.instances.size() == there.instances.size());
    for (std::size_t i = 0; i < here.instances.size(); ++i) {
      CHECK((here.instances[i].position - there.instances[i].position).norm() < 1e-6f);
      CHECK((here.instances[i].body_position - there.instances[i].body_position).norm() < 1e-6f);
    }
    REQUIRE(here.lighting.lights.size() == there.lighting.lights.size());
    for (std::size_t i = 0; i < here.lighting.lights.size(); ++i) {
      CHECK((here.lighting.lights[i].position - there.lighting.lights[i].position).norm() < 1e-6f);
      CHECK((here.lighting.lights[i].direction - there.lighting.lights[i].direction).norm() < 1e-6f);
    }
    CHECK((here.lighting.shadow_clip - there.lighting.shadow_clip).norm() < 1e-4f);
    CHECK((here.camera.view - there.camera.view).norm() < 1e-6f);
    REQUIRE(here.views.size() == there.views.size());
    for (std::size_t i = 0; i < here.views.size(); ++i) {
      CHECK((here.views[i].camera.clip_from_world() - there.views[i].camera.clip_from_world()).norm() < 1e-4f);
      CHECK(there.views[i].camera.origin_m == kFar);
    }
  }
}

TEST_CASE("Flashes, contacts, forces and the mouse 300 km from the origin are where they are at the origin") {
  const DrawList here = drawn(Vector3d::Zero(), "off"), there = drawn(kFar, "off");
  const auto glows = [&](const DrawList& list, const Vector3d& shift) {
    Flashes flashes{Settings{}};
    contact_event_t e{};
    e.kind = contact_event_t::HIT, e.normal.z = 1, e.approach_speed_m_s = 1;
    e.point_m = to_vec3(Vector3d(shift + Vector3d(0.0123, 0.0456, 0.0789)));
    flashes.add(e, sync::host_time(0));
    return flashes.frame(sync::host_time(0), list.camera);
  };
  CHECK((glows(here, Vector3d::Zero()).front().centre - glows(there, kFar).front().centre).norm() < 1e-6f);
  const auto strokes = [](const Vector3d& shift) {
    contact_t c{};
    c.normal.z = 1, c.normal_force_N = 3, c.tool = -1, c.point_count = 1;
    contact_point_t p{};
    p.a_world_m = p.b_world_m = to_vec3(Vector3d(shift + Vector3d(0.0123, 0.0456, 0.0789)));
    c.points = {p};
    ToolPose tool;
    tool.known = true;
    tool.proxy.translation() = shift + Vector3d(0.1, 0.2, 0.3), tool.device.translation() = shift + Vector3d(0.1, 0.2, 0.29);
    std::vector<Stroke> out;
    append_contacts(out, std::vector{c}, shift);
    append_contact_forces(out, std::vector{c}, 0.02f, shift);
    append_hand_force(out, tool, {2, 0, 0}, 0.02f, shift);
    append_tool(out, tool, shift);
    return out;
  };
  const auto a = strokes(Vector3d::Zero()), b = strokes(kFar);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK((a[i].from - b[i].from).norm() + (a[i].to - b[i].to).norm() < 1e-6f);
  const SceneView room(lit_room(Vector3d::Zero()), {}, Settings{});
  const auto hit = pick_surface(here, room.geometries(), 0.4f, 0.6f), far_hit = pick_surface(there, room.geometries(), 0.4f, 0.6f);
  REQUIRE(hit);
  REQUIRE(far_hit);
  CHECK((*far_hit - kFar - *hit).norm() < 1e-5);
}

TEST_CASE("The relief of a far body is drawn from a place near the eye at which it looks the same") {
  const Vector3d eye(3e5, -2e5, 64);
  for (const auto& [u_m, v_m] : {std::pair{0.05f, 0.05f}, std::pair{0.1f, 0.2f}, std::pair{0.75f, 0.5f}}) {
    const Eigen::Vector2f size(u_m, v_m);
    Eigen::Isometry3d body = Eigen::Isometry3d::Identity();
    body.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
    const Vector3d near = repeated_place(size.cast<double>(), body, eye);
    CHECK((near - eye).norm() < 1.5);
    // A place beside the eye has the same coordinates in the map, except for whole repetitions.
    const Vector3d place = eye + Vector3d(0.123, 0.456, 0.0789);
    for (const Vector3d& normal : {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY()), Vector3d(Vector3d::UnitZ())}) {
      const BumpAxes axes = bump_axes(normal);
      const Eigen::Vector2d whole = bump_at(size, axes, body.inverse() * place) -
                                    bump_at(size, axes, body.linear().transpose() * (place - near));
      CHECK((whole.array() - whole.array().round()).abs().maxCoeff() < 1e-4);
    }
    CHECK(repeated_place(size.cast<double>(), body, {10, 20, 30}) == body.translation());
  }
  CHECK(repeated_place({0.1, 0.1 * std::sqrt(2.0)}, Eigen::Isometry3d::Identity(), eye).isZero(0));
}
