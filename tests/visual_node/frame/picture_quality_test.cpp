// The steps of the quality ladder and a degraded resolution, compared as pictures.
#include <catch2/catch.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "tests/visual_node/support/offscreen.h"
#include "visual_node/frame/marker.h"
#include "visual_node/scene_view/quality.h"

using namespace tactus;
using namespace tactus::visual;
using namespace tactus::test;

namespace {

// A ball over a lit floor, in shadow.
scene_t ball_over_floor() {
  scene_t scene = floor_from_above(6);
  add_visual(scene, add_body(scene, {0.3, 0, 1}), shape_def_t::SPHERE, {0.2, 0, 0});
  scene.lights = {spot({-1, 0, 3}, 1.2, 1.4)};
  scene.lights[0].direction = to_vec3(Eigen::Vector3d(0.5, 0, -1).normalized());
  return scene;
}

// A flash in the middle of the picture, half as high as the picture.
Glow flash() {
  Glow glow;
  glow.centre << 0, 0, 0, 0.5f;
  glow.u << 0.5f, 0, 0, 0;
  glow.v << 0, 0.5f, 0, 0;
  glow.colour << 1, 0.6f, 0.2f, 0;
  return glow;
}

Quality step(std::size_t i) { return kQualities.at(i); }

}  // namespace

TEST_CASE("Every quality step shows the same picture at lower resolution, the last one without shadows") {
  const scene_t scene = ball_over_floor();
  const auto floor_at = [](const Image& image, double x) {
    return image.at(kWidth / 2, kHeight / 2 - static_cast<int>(std::lround(x * scale_px(6)))).x();
  };
  const Image full = render(scene);
  const auto i = GENERATE(range<std::size_t>(0, 4));
  const Image image = render(scene, {}, {}, {}, step(i));
  CHECK((image.rgba == full.rgba) == (i == 0));
  // The same light away from edges; the ball is at x = 0.3 and casts its shadow at 0.95.
  for (const double x : {-0.6, -0.3, 1.6}) CHECK(floor_at(image, x) == Approx(floor_at(full, x)).margin(2));
  REQUIRE(floor_at(full, 0.95) == 0);
  if (step(i).shadow_divisor > 0)
    CHECK(floor_at(image, 0.95) == 0);
  else
    CHECK(floor_at(image, 0.95) > 20);
  // Only pixels at edges, or in the missing shadow, differ.
  int different = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) different += (image.at(x, y) - full.at(x, y)).cwiseAbs().maxCoeff() > 12;
  CHECK(different < kWidth * kHeight / 50);
}

TEST_CASE("Marker and text keep all their pixels at every step and resolution") {
  std::vector<Rect> overlay;
  append_marker(overlay, 4711, std::vector<std::int64_t>{17}, kHeight);
  const Image full = render(ball_over_floor(), {}, overlay);
  for (const Quality& q : {step(1), step(2), step(3), degraded(step(0), 0.25), degraded(step(3), 0.1)}) {
    const Image image = render(ball_over_floor(), {}, overlay, {}, q);
    const std::size_t row = kWidth * 4, strip = kMarkerCells * kMarkerCell_px * 4;
    for (std::size_t y = 0; y < kMarkerCell_px; ++y)
      for (std::size_t x = 0; x < strip; ++x) REQUIRE(image.rgba[y * row + x] == full.rgba[y * row + x]);
  }
}

TEST_CASE("A flash has the same sharpness in every step, unless a profile degrades the picture") {
  display();
  Renderer renderer(kWidth, kHeight, 64);
  DrawList list;
  list.lighting.background = {0.1f, 0.05f, 0.02f};
  list.glows = {flash()};
  const Image full = draw(renderer, list);
  CHECK(full.at(kWidth / 2, kHeight / 2).x() > full.at(0, 0).x() + 20);
  for (const std::size_t i : {1, 2, 3}) {
    const Image image = draw(renderer, list, step(i));
    for (std::size_t k = 0; k < image.rgba.size(); ++k) REQUIRE(std::abs(image.rgba[k] - full.rgba[k]) <= 1);
  }
  SECTION("blocks of 4 pixels at a quarter of the resolution") {
    const Image image = draw(renderer, list, degraded(step(0), 0.25));
    int levels = 0;
    for (int y = 0; y < kHeight; y += 4)
      for (int x = 0; x < kWidth; x += 4) {
        for (int k = 1; k < 16; ++k) REQUIRE(image.at(x + k % 4, y + k / 4) == image.at(x, y));
        levels += image.at(x, y) != image.at(0, 0);
      }
    CHECK(levels > 100);
  }
}

TEST_CASE("A scaled picture has its own light up to its last pixel") {
  display();
  scene_t scene = floor_from_above(2);  // fills the picture, on a dark background
  scene.ambient = grey(1);
  const SceneView view(scene, {}, {});
  Renderer renderer(kWidth, kHeight, 64);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  const std::vector<Eigen::Isometry3d> poses{Eigen::Isometry3d::Identity()};
  const DrawList list = view.draw(poses, {});
  DrawList dark;
  for (const Quality& q : {step(1), step(2), step(3), degraded(step(0), 0.3), degraded(step(0), 0.005)}) {
    draw(renderer, dark, degraded(step(0), 0.9));
    const Image image = draw(renderer, list, q);
    REQUIRE(image.rgba[0] > 100);
    for (std::size_t k = 4; k < image.rgba.size(); ++k) REQUIRE(image.rgba[k] == image.rgba[k % 4]);
  }
}

TEST_CASE("Warming up does not change a picture") {
  display();
  const scene_t scene = ball_over_floor();
  const SceneView view(scene, {}, {});
  Renderer renderer(kWidth, kHeight, Settings{}.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
  const DrawList list = view.draw(poses, {});
  const Image before = draw(renderer, list, step(1));
  renderer.warm_up(list);
  CHECK(draw(renderer, list, step(1)).rgba == before.rgba);
}

TEST_CASE("A resolution is a factor and never improves a step") {
  CHECK(degraded(step(2), 0) == step(2));
  CHECK(degraded(step(2), 1) == step(2));
  CHECK(degraded(step(0), 0.25).scale == 0.25);
  CHECK(degraded(step(2), 0.9).scale == step(2).scale);
  CHECK(degraded(step(3), 0.25).shadow_divisor == 0);
}
