#include "visual_node/lens/lens.h"

#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>

#include "tests/visual_node/support/test_scene.h"
#include "visual_node/lens/off_axis.h"
#include "visual_node/lens/stereo.h"

using namespace tactus;
using namespace tactus::visual;
using Eigen::Vector3d;

namespace {

// Looks along +y from 3 m high, slightly down.
scene_t looking_down() {
  scene_t scene = test::empty_scene();
  scene.camera = to_pose(Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3) *
                                           Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()) *
                                           Eigen::AngleAxisd(0.4, Vector3d::UnitY())));
  return scene;
}

Settings room(const std::string& name, const std::string& wall = "first") {
  Settings s;
  s.room = name, s.wall = wall;
  return s;
}

Eigen::Vector2f seen(const Camera& camera, const Vector3d& place) {
  const Eigen::Vector4f clip = camera.clip_from_world() * place.cast<float>().homogeneous();
  return clip.head<2>() / clip.w();
}

}  // namespace

TEST_CASE("A cave is level around the camera, and its front faces the heading of the camera") {
  const scene_t scene = looking_down();
  const Lens front(scene, room("cave4", "front"), 512, 512), floor(scene, room("cave4", "floor"), 512, 512);
  REQUIRE(front.warning().empty());
  // The eye is 1.6 m above the floor, which is then 1.4 m high, and 1.524 m before the front.
  const Vector3d left_foot(1 - 1.524, 2 + 1.524, 1.4);
  CHECK((seen(front.camera({}), left_foot) - Eigen::Vector2f(-1, -1)).norm() < 1e-4f);
  CHECK((seen(floor.camera({}), left_foot) - Eigen::Vector2f(-1, 1)).norm() < 1e-4f);
  // A head moves the eye, not the room.
  const Eigen::Isometry3d head = Eigen::Translation3d(0.3, 2.5, 2.7) * Eigen::AngleAxisd(1, Vector3d::UnitZ());
  CHECK((front.camera(head).eye - head.translation().cast<float>()).norm() < 1e-6f);
  CHECK((seen(front.camera(head), left_foot) - Eigen::Vector2f(-1, -1)).norm() < 1e-4f);
}

TEST_CASE("A desktop screen is upright before the camera at any camera pose") {
  const scene_t scene = looking_down();
  const Lens lens(scene, room("desk"), 640, 360);
  const Eigen::Isometry3d camera = to_eigen(scene.camera);
  // The middle of the screen, and its upper edge.
  CHECK(seen(lens.camera({}), camera * Vector3d(0.6, 0, 0)).norm() < 1e-4f);
  CHECK(seen(lens.camera({}), camera * Vector3d(0.6, 0, 0.1494)).y() == Approx(1).margin(1e-4));
}

TEST_CASE("A missing room or wall is reported, and the camera of the scene is used") {
  const scene_t scene = looking_down();
  const Lens plain(scene, room("none"), 640, 480);
  const auto [name, wall, sentence] = GENERATE(
      std::tuple("cave4", "ceiling", "the room cave4 has no wall ceiling, only left, front, right, floor"),
      std::tuple("/no/such/room.csv", "first", "the room /no/such/room.csv cannot be read"));
  const Lens lens(scene, room(name, wall), 640, 480);
  CHECK_THAT(lens.warning(), Catch::StartsWith(sentence));
  CHECK(lens.camera({}).clip_from_world() == plain.camera({}).clip_from_world());
}

TEST_CASE("Stereo halves and colours show both eyes for one head pose") {
  const scene_t scene = looking_down();
  Settings s = room(GENERATE("none", "cave4"), "first");
  const Eigen::Isometry3d head = to_eigen(scene.camera) * Eigen::Translation3d(0, 0.1, 0);
  const Lens lens(scene, s, 640, 480);
  CHECK(stereo_views(lens, head, s).size() == 1);
  s.stereo = GENERATE("side_by_side", "top_bottom", "anaglyph");
  CAPTURE(s.room, s.stereo);
  const auto views = stereo_views(lens, head, s);
  REQUIRE(views.size() == 2);
  const auto expected = eyes(head, s.eye_distance_m);
  for (std::size_t i = 0; i < 2; ++i) CHECK((views[i].camera.eye - expected[i].cast<float>()).norm() < 1e-5f);
  // The views do not overlap.
  const bool apart = views[0].x + views[0].width <= views[1].x || views[1].y + views[1].height <= views[0].y;
  const bool coloured =
      views[0].red && !views[0].green && !views[0].blue && !views[1].red && views[1].green && views[1].blue;
  CHECK(apart != coloured);
  CHECK(coloured == (s.stereo == "anaglyph"));
  if (s.room != "none") return;
  // The window that moves with the head is as wide as the camera's view at 1 m, and both eyes see it at one
  // place.
  const Camera plain = lens.camera(head);
  for (const double y : {-0.3, 0.2})
    for (const View& v : views) {
      const Vector3d place = head * Vector3d(s.stereo_distance_m, y, 0.1);
      CHECK((seen(v.camera, place) - seen(plain, place)).norm() < 1e-4f);
    }
}
