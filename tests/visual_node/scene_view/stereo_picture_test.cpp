// Stereo pictures as drawn by the device.
#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "tests/visual_node/support/offscreen.h"

using namespace tactus;
using namespace tactus::test;
using Eigen::Vector3d;

namespace {

// A bright ball 2 m ahead, twice as far as the window.
scene_t ball() {
  scene_t scene = empty_scene();
  add_visual(scene, add_body(scene, {2, 0, 0}), shape_def_t::SPHERE, {0.05, 0, 0});
  scene.visuals[0].emissive = grey(1);
  return scene;
}

// Mean column of the bright pixels of a channel between two columns, and mean row; -1: none.
Eigen::Vector2d middle(const Image& image, int channel, int from, int to, int top = 0, int bottom = kHeight) {
  double n = 0;
  Eigen::Vector2d sum(0, 0);
  for (int y = top; y < bottom; ++y)
    for (int x = from; x < to; ++x)
      if (image.at(x, y)[channel] > 128) sum += Eigen::Vector2d(x + 0.5, y + 0.5), n += 1;
  return n > 0 ? Eigen::Vector2d(sum / n) : Eigen::Vector2d(-1, -1);
}

}  // namespace

TEST_CASE("Each half of a stereo picture has the ball where its eye sees it") {
  visual::Settings settings;
  settings.event_marker = "off";
  // A point at infinity has the distance of the eyes on the window at 1 m; at 2 m half of that.
  const double half_px = kWidth / 2.0, window_m = std::tan(0.5), parallax_px = 0.064 / 2 / window_m * half_px;
  settings.stereo = "anaglyph";
  const Image coloured = render(ball(), settings);
  const Eigen::Vector2d red = middle(coloured, 0, 0, kWidth), green = middle(coloured, 1, 0, kWidth);
  CHECK(green.x() - red.x() == Approx(parallax_px).margin(0.5));
  CHECK(green.y() == Approx(red.y()).margin(0.5));
  CHECK(red.x() + green.x() == Approx(kWidth).margin(0.5));

  settings.stereo = "side_by_side";
  const Image beside = render(ball(), settings);
  const double left = middle(beside, 1, 0, kWidth / 2).x(), right = middle(beside, 1, kWidth / 2, kWidth).x();
  CHECK(left == Approx(0.5 * red.x()).margin(0.5));
  CHECK(right - kWidth / 2 == Approx(0.5 * green.x()).margin(0.5));

  settings.stereo = "top_bottom";
  const Image above = render(ball(), settings);
  CHECK(middle(above, 1, 0, kWidth, 0, kHeight / 2).x() == Approx(red.x()).margin(0.5));
  CHECK(middle(above, 1, 0, kWidth, kHeight / 2, kHeight).x() == Approx(green.x()).margin(0.5));
  CHECK(middle(above, 1, 0, kWidth, 0, kHeight / 2).y() == Approx(0.5 * red.y()).margin(0.5));
}

TEST_CASE("Smaller stereo pictures show the same, with flashes where each eye sees them") {
  visual::Settings settings;
  settings.stereo = "side_by_side";
  const Image fine = render(ball(), settings),
              coarse = render(ball(), settings, {}, {}, visual::kQualities.back());
  for (const int from : {0, kWidth / 2})
    CHECK(middle(coarse, 1, from, from + kWidth / 2).x() ==
          Approx(middle(fine, 1, from, from + kWidth / 2).x()).margin(1));

  display();
  const visual::SceneView view(empty_scene(), {}, settings);
  visual::Renderer renderer(kWidth, kHeight, settings.shadow_size);
  renderer.load(view.geometries(), view.lighting());
  visual::DrawList list = view.draw({}, {});
  // As large as the ball and in its place, facing the head.
  list.glows.push_back({{2, 0, 0, 0.5f}, {0, -0.1f, 0, 0}, {0, 0, 0.1f, 0}, {1, 1, 1, 0}});
  const Image flashed = draw(renderer, list);
  for (const int from : {0, kWidth / 2})
    CHECK(middle(flashed, 1, from, from + kWidth / 2).x() ==
          Approx(middle(fine, 1, from, from + kWidth / 2).x()).margin(1));
}
