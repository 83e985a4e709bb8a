#include <catch2/catch.hpp>
#include <set>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "tests/visual_node/support/offscreen.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

// The slanted edge of a white emitter on black: the brightness levels of its pixels, and the messages.
std::pair<std::set<int>, std::vector<std::string>> levels(int samples, const Quality& quality = {}) {
  display();
  scene_t scene = empty_scene();
  add_visual(scene, add_body(scene, {2, 0, 0}), shape_def_t::BOX, {0.5, 0.5, 0.5});
  scene.visuals[0].emissive = grey(1);
  scene.visuals[0].shape.pose = to_pose(Eigen::Isometry3d(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX())));
  const SceneView view(scene, {}, Settings{});
  Renderer renderer(kWidth, kHeight, 64, samples);
  renderer.load(view.geometries(), view.lighting());
  const std::vector<Eigen::Isometry3d> poses{to_eigen(scene.bodies[0].pose)};
  const Image image = draw(renderer, view.draw(poses, {}), quality);
  std::set<int> seen;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) seen.insert(static_cast<int>(image.at(x, y).x()));
  return {seen, renderer.take_warnings()};
}

}  // namespace

TEST_CASE(
    "With four samples a pixel an edge has intermediate levels in linear light, with one it has none") {
  CHECK(levels(1).first == std::set<int>{0, 255});
  const auto [seen, messages] = levels(4);
  if (!messages.empty()) return;  // the device supports fewer samples and reports it
  CHECK(seen.size() == 5);
  // Each sample is a quarter of the light.
  for (const int level : seen) {
    double nearest = 255;
    for (int quarter = 0; quarter <= 4; ++quarter)
      nearest = std::min(nearest, std::abs(level - srgb(quarter / 4.0)));
    CHECK(nearest <= kTolerance);
  }
}

TEST_CASE("A number of samples above the limit of the device is reported and reduced") {
  const auto [seen, messages] = levels(64);
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("anti_aliasing=64"));
  CHECK(seen.size() > 2);
}

TEST_CASE("Edges stay smooth in a smaller picture that is scaled up") {
  for (const Quality& q : kQualities) {
    const auto [seen, messages] = levels(4, q);
    CHECK(*seen.rbegin() == 255);
    CHECK(*seen.begin() == 0);
    CHECK(seen.size() > 2);
  }
}
