// The view follows a tool named "head".
#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/pointing.h"
#include "tests/visual_node/support/test_scene.h"
#include "visual_node/frame/frame_composer.h"

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kHeadRun = 3;

// A ball 2 m ahead of the scene's camera, which is 1 m high and looks along +y; and a head.
scene_t scene_with_head() {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {0, 2, 1}), shape_def_t::SPHERE, {0.1, 0, 0});
  scene.camera = test::at(0, 0, 1);
  scene.camera.orientation =
      to_quat(Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ())));
  test::add_tool(scene, 0.005);
  scene.tools[0].name = "head";
  return scene;
}

tool_state_t head_at(sync::HostTime t, const Eigen::Vector3d& position, double yaw_rad) {
  tool_state_t m{};
  m.header.sim_time_ns = -1;
  m.header.publish_time_ns = sync::to_ns(t);
  m.header.run_id = kHeadRun;
  m.header.incarnation = 9;
  m.device.position_m = to_vec3(position);
  m.device.orientation = to_quat(Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())));
  m.proxy = m.device;
  return m;
}

struct Seen {
  FrameComposer composer{kHeadRun, Settings{}};
  sync::HostTime now = sync::host_time(10'000'000'000);
  Seen() { composer.load(scene_with_head(), {}, Settings{}); }

  Frame frame(sync::Nanoseconds delay = {}, sync::Nanoseconds view_delay = {}) {
    return composer.frame(now, 0, delay, now, view_delay);
  }
  // Publishes a head at rest for a time t.
  void hold(const Eigen::Vector3d& position, double yaw_rad, milliseconds t = milliseconds(100)) {
    for (const sync::HostTime end = now + t; now < end; now += milliseconds(1))
      composer.push(head_at(now, position, yaw_rad), now);
  }
};

// Place of a world point in the picture, -1 .. 1; x to the right.
Eigen::Vector2f image_position(const Frame& f, const Eigen::Vector3f& point) {
  const Eigen::Vector4f clip = f.list.camera.clip_from_world() * point.homogeneous();
  return clip.head<2>() / clip.w();
}
const Eigen::Vector3f kBall{0, 2, 1};

}  // namespace

TEST_CASE_METHOD(Seen, "Without a tracked head the view is that of the scene, and the health reports it") {
  const Frame f = frame();
  CHECK(image_position(f, kBall).norm() < 1e-5f);
  CHECK(f.note.find("no head yet") != std::string::npos);
}

TEST_CASE_METHOD(Seen, "The eye is at the head, and the head rotates the camera of the scene") {
  hold({0, 0.5, 1}, 0);
  Frame f = frame();
  CHECK((f.list.camera.eye - Eigen::Vector3f(0, 0.5f, 1)).norm() < 1e-5f);
  CHECK(image_position(f, kBall).norm() < 1e-5f);  // straight ahead, only nearer
  CHECK(f.note.find("head") == std::string::npos);
  hold({-2, 2, 1}, -std::numbers::pi / 2);  // on the left side, turned to the right
  f = frame();
  CHECK(image_position(f, kBall).norm() < 1e-5f);
  hold({-2, 2, 1}, -std::numbers::pi / 2 + 0.1);  // turned to the left: the point ahead moves to the right
  CHECK(image_position(frame(), kBall).x() > 0.05f);
}

TEST_CASE_METHOD(Seen, "The head of the user is not drawn") {
  const std::size_t before = frame().list.instances.size();
  hold({0, 0.5, 1}, 0);
  CHECK(frame().list.instances.size() == before);
}

TEST_CASE_METHOD(Seen, "A lost head keeps the view, and the health reports it until the head returns") {
  hold({0, 0.5, 1}, 0.2);
  const Frame there = frame();
  now += milliseconds(100);
  CHECK(frame().note.find("head") == std::string::npos);  // a stutter is not a loss
  for (int i = 0; i < 3; ++i) {
    now += milliseconds(1000);
    const Frame f = frame();
    CHECK(f.list.camera.view == there.list.camera.view);
    CHECK(f.note.find("the head is lost: the view stays") != std::string::npos);
  }
  hold({0, 0.6, 1}, 0.2);
  CHECK(frame().note.find("head") == std::string::npos);
  CHECK(frame().list.camera.eye.y() == Approx(0.6f));
}

TEST_CASE_METHOD(Seen, "A profile delays the view, and a playout policy does not") {
  hold({0, 0, 1}, 0);
  hold({0, 1, 1}, 0, milliseconds(60));
  CHECK(frame(milliseconds(80)).list.camera.eye.y() == Approx(1).margin(1e-5));
  CHECK(frame(milliseconds(80), milliseconds(80)).list.camera.eye.y() == Approx(0).margin(1e-5));
}

TEST_CASE("The listener keeps its place relative to the eye") {
  scene_t scene = scene_with_head();
  scene.listener = scene.camera;
  scene.listener.position_m.y += 0.1;  // 0.1 m ahead of the eye
  const Eigen::Isometry3d view = view_of(
      scene, {5, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitZ())));
  CHECK((view.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitX()).norm() <
        1e-12);  // looks along +x now
  CHECK((listener_of(scene, view).translation() - Eigen::Vector3d(5.1, 0, 0)).norm() < 1e-12);
}
