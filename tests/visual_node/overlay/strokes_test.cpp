#include "visual_node/overlay/strokes.h"

#include <catch2/catch.hpp>
#include <limits>
#include <tactus/scene_t.hpp>

#include "tests/visual_node/support/offscreen.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

const Pen kRed{{1, 0, 0, 1}, 4};

// The floor from above with these strokes over it.
Image drawn(const std::vector<Stroke>& strokes, const std::string& stereo = "off") {
  display();
  Settings settings;
  settings.stereo = stereo;
  const scene_t scene = floor_from_above(2);
  const SceneView view(scene, {}, settings);
  Renderer renderer(kWidth, kHeight, settings.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs());
  std::vector<Eigen::Isometry3d> poses{to_eigen(scene.bodies[0].pose)};
  DrawList list = view.draw(poses, {});
  list.strokes = strokes;
  return draw(renderer, list);
}

bool red(const Eigen::Vector3d& c) { return c.x() > 200 && c.y() < 60 && c.z() < 60; }
int count_red(const Image& image) {
  int n = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) n += red(image.at(x, y));
  return n;
}

}  // namespace

TEST_CASE("A line connects its ends with the given width") {
  std::vector<Stroke> strokes;
  append_line(strokes, {0, 0.3f, 0}, {0, -0.3f, 0}, kRed);
  const Image image = drawn(strokes);
  // World y points to the left of the picture.
  const int half = static_cast<int>(0.3 * scale_px(2));
  CHECK(red(image.at(kWidth / 2 - half + 2, kHeight / 2)));
  CHECK(red(image.at(kWidth / 2 + half - 2, kHeight / 2)));
  CHECK_FALSE(red(image.at(kWidth / 2 - half - 6, kHeight / 2)));
  CHECK_FALSE(red(image.at(kWidth / 2 + half + 6, kHeight / 2)));
  int wide = 0;
  for (int y = 0; y < kHeight; ++y) wide += red(image.at(kWidth / 2, y));
  CHECK(wide == 4);
}

TEST_CASE("A line is clipped at the eye and not drawn behind it") {
  std::vector<Stroke> strokes;
  append_line(strokes, {0, 0, 5}, {0.5f, 0, 0}, kRed);  // the eye is at 2 m and looks down; picture up is +x
  CHECK(red(drawn(strokes).at(kWidth / 2, kHeight / 2 - static_cast<int>(0.5 * scale_px(2)) - 4)));
  strokes.clear();
  append_line(strokes, {0, 0, 5}, {0.5f, 0, 3}, kRed);
  CHECK(count_red(drawn(strokes)) == 0);
}

TEST_CASE("Each eye sees a line in its own half of the picture") {
  std::vector<Stroke> strokes;
  append_cross(strokes, {0, 0, 0}, 0.2f, kRed);
  const Image image = drawn(strokes, "side_by_side");
  int left = 0, right = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) (x < kWidth / 2 ? left : right) += red(image.at(x, y));
  CHECK(left > 50);
  CHECK(std::abs(left - right) <= left / 5);
}

TEST_CASE("An arrow ends at its tip and is not drawn if it is empty or not finite") {
  std::vector<Stroke> strokes;
  append_arrow(strokes, {1, 2, 3}, {0, 0, 0.5f}, kRed);
  REQUIRE(strokes.size() == 5);
  CHECK(strokes[0].to.head<3>().isApprox(Eigen::Vector3f(1, 2, 3.5f)));
  for (std::size_t i = 1; i < 5; ++i) CHECK(strokes[i].from.head<3>().isApprox(Eigen::Vector3f(1, 2, 3.5f)));
  strokes.clear();
  append_arrow(strokes, {0, 0, 0}, {0, 0, 0}, kRed);
  append_arrow(strokes, {0, 0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, kRed);
  append_arrow(strokes, {std::numeric_limits<float>::infinity(), 0, 0}, {1, 0, 0}, kRed);
  append_line(strokes, {2 * kMaxCoordinate_m, 0, 0}, {1, 0, 0}, kRed);
  append_spring(strokes, {0, 0, 0}, {0, 0, 0}, 0.1f, kRed);
  CHECK(strokes.empty());
}

TEST_CASE("A spring connects both ends without a gap") {
  std::vector<Stroke> strokes;
  append_spring(strokes, {0, 0, 0}, {1, 0, 0}, 0.1f, kRed);
  REQUIRE(strokes.size() == 2 * kSpringTurns + 1);
  CHECK(strokes.front().from.head<3>().norm() == 0);
  CHECK(strokes.back().to.head<3>().isApprox(Eigen::Vector3f(1, 0, 0)));
  for (std::size_t i = 1; i < strokes.size(); ++i) CHECK(strokes[i].from.head<3>() == strokes[i - 1].to.head<3>());
}
