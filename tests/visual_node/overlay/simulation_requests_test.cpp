#include "visual_node/overlay/simulation_requests.h"

#include <catch2/catch.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/times.h"
#include "tests/visual_node/support/test_scene.h"
#include "visual_node/scene_view/scene_view.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;
using tactus::test::at_ms;

namespace {

sim_reply_t reply(std::int64_t id, bool paused) {
  sim_reply_t m{};
  m.id = id, m.done = 1, m.paused = paused, m.text = "done";
  return m;
}

// A floor seen from 2 m straight above; a box of 20 cm stands on it at (0, -0.5).
struct SmallRoom {
  scene_t scene = empty_scene();
  SmallRoom() {
    add_visual(scene, add_body(scene, {0, 0, 0}), shape_def_t::PLANE, {10, 10, 0});
    add_visual(scene, add_body(scene, {0, -0.5, 0.1}), shape_def_t::BOX, {0.2, 0.2, 0.2});
    scene.camera = to_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2) *
                                             Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitY())));
  }
  std::optional<Eigen::Vector3d> hit(float x, float y, const std::string& stereo = "off") const {
    Settings settings;
    settings.stereo = stereo;
    const SceneView view(scene, {}, settings);
    std::vector<Eigen::Isometry3d> poses;
    for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
    return pick_surface(view.draw(poses, {}), view.geometries(), x, y);
  }
};

}  // namespace

TEST_CASE("The mouse points at the visible surface under it") {
  const SmallRoom room;
  const auto middle = room.hit(0.5f, 0.5f);
  REQUIRE(middle);
  CHECK(middle->norm() < 1e-3f);
  // Picture right is -y: at 2 m the picture is 2 * 2 * tan(0.5) wide, the box's top 0.2 m nearer.
  const auto share = [](double y_m, double depth_m) {
    return static_cast<float>(0.5 - y_m / (2 * depth_m * std::tan(0.5)));
  };
  const auto on_box = room.hit(share(-0.5, 1.8), 0.5f);
  REQUIRE(on_box);
  CHECK(on_box->isApprox(Eigen::Vector3d(0, -0.5, 0.2), 1e-3));
  const auto beside = room.hit(share(0.5, 2), 0.5f);
  REQUIRE(beside);
  CHECK(beside->isApprox(Eigen::Vector3d(0, 0.5, 0), 1e-3));
  CHECK_FALSE(room.hit(-0.2f, 0.5f));
  CHECK_FALSE(room.hit(std::nanf(""), 0.5f));
}

TEST_CASE("The mouse points at a ball up to its edge and at the floor beside it") {
  for (const double radius_m : {0.01, 0.03, 0.08})
    for (const double y_m : {-0.6, 0.0, 0.3}) {
      CAPTURE(radius_m, y_m);
      SmallRoom room;
      const int kind = shape_def_t::SPHERE;
      add_visual(room.scene, add_body(room.scene, {0.5, y_m, radius_m}), kind, {radius_m, 0, 0});
      // Straight above it, m from its middle along the picture's vertical: at distance d of the plane through
      // its middle the tangent of the field of view gives the pixel row; the picture is 640 x 480.
      const auto hit_beside = [&](double up_m) {
        const double depth_m = 2 - radius_m, scale = 1 / (2 * depth_m * std::tan(0.5));
        return room.hit(static_cast<float>(0.5 - y_m * scale),
                        static_cast<float>(0.5 - (0.5 + up_m) * scale * 640 / 480));
      };
      const Eigen::Vector3d middle(0.5, y_m, radius_m);
      const auto on = hit_beside(0.9 * radius_m), beside = hit_beside(1.5 * radius_m);
      REQUIRE(on);
      REQUIRE(beside);
      // Twelve segments around and from pole to pole: within 1 - cos(pi / 12)^2 = 6.7 % of its radius.
      CHECK((*on - middle).norm() == Approx(radius_m).epsilon(0.067));
      CHECK(std::abs(beside->z()) < 1e-3f);
    }
}

TEST_CASE("In a stereo picture the mouse points within the half under it") {
  const SmallRoom room;
  for (const float x : {0.25f, 0.75f}) {
    const auto hit = room.hit(x, 0.5f, "side_by_side");
    REQUIRE(hit);
    CHECK(std::abs(hit->x()) < 1e-3f);
    CHECK(std::abs(hit->y()) < 0.1f);  // the eyes are 64 mm apart and see the floor behind their window
    CHECK(std::abs(hit->z()) < 1e-3f);
  }
}

TEST_CASE("The pointer moves continuously and is a valid device") {
  MousePointer pointer;
  CHECK_FALSE(pointer.state(at_ms(0)));
  pointer.aim({1, 2, 0});
  auto m = pointer.state(at_ms(0));
  REQUIRE(m);
  CHECK(to_eigen(m->pose.position_m).isApprox(Eigen::Vector3d(1, 2, 0)));
  pointer.aim({-9, 2, 0});
  Eigen::Vector3d before = to_eigen(m->pose.position_m);
  int ticks = 0;
  while (before.x() > -9 && ++ticks < 1000) {
    m = pointer.state(at_ms(ticks * 16));
    m->header.run_id = m->header.incarnation = 1;
    REQUIRE(valid(*m));
    const Eigen::Vector3d now = to_eigen(m->pose.position_m);
    CHECK((now - before).norm() <= MousePointer::kMaxSpeed_m_s * 0.016 + 1e-9);
    before = now;
  }
  CHECK(ticks == 125);  // 10 m at 5 m/s, 16 ms each
}

TEST_CASE("A key press sends one command and repeats it for a limited time until it is answered") {
  SimulationRequests requests;
  CHECK_FALSE(requests.step(at_ms(0)));
  requests.request(Action::kPauseOrResume, 7);
  auto c = requests.step(at_ms(0));
  REQUIRE(c);
  CHECK(c->kind == sim_command_t::PAUSE);
  CHECK(c->id == 7);
  CHECK(valid(*c));
  CHECK_FALSE(requests.step(at_ms(50)));
  CHECK(requests.step(at_ms(100))->id == 7);
  requests.push(reply(6, true));  // a reply to another program
  CHECK(requests.step(at_ms(200)));
  requests.push(reply(7, true));
  CHECK(requests.take_answer() == "done");
  CHECK_FALSE(requests.step(at_ms(300)));
  requests.request(Action::kPauseOrResume, 8);  // the world is paused: resume
  CHECK(requests.step(at_ms(400))->kind == sim_command_t::RESUME);
  requests.request(Action::kStep, 9);
  CHECK(requests.step(at_ms(3500)).has_value() == false);
  CHECK(requests.take_answer() == "no sim_node answers");
  CHECK_FALSE(requests.step(at_ms(3600)));
}

TEST_CASE("Each key press sends its own command, and held keys do not fill memory") {
  SimulationRequests requests;
  for (int i = 0; i < 1000; ++i) requests.request(i % 2 ? Action::kStep : Action::kReset, i + 1);
  std::size_t answered = 0;
  while (const auto c = requests.step(at_ms(0))) {
    CHECK(valid(*c));
    CHECK(c->kind == (c->id % 2 ? sim_command_t::RESET : sim_command_t::STEP));
    CHECK(c->steps == (c->kind == sim_command_t::STEP ? 1 : 0));
    requests.push(reply(c->id, false));
    ++answered;
  }
  CHECK(answered == SimulationRequests::kMaxPending);
}
