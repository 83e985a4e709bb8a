// Screen passes against their definitions, computed from the picture without them.
#include <catch2/catch.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/pass_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/uniform_t.hpp>

#include "tests/visual_node/support/reference.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;
using Eigen::Vector3d;
using reference::linear;

namespace {

// Coloured balls in the light of a lamp over a bright floor.
scene_t colourful() {
  scene_t scene = floor_from_above(3);
  scene.visuals[0].diffuse = to_vec3f({0.2, 0.7, 0.3});
  scene.background = to_vec3f({0.1, 0.1, 0.4});
  for (int i = 0; i < 5; ++i) {
    add_visual(scene, add_body(scene, {0.4 * i - 0.8, 0.3 * i - 0.6, 0.3}),
               i % 2 ? shape_def_t::BOX : shape_def_t::SPHERE, {0.25, 0.3, 0.2});
    scene.visuals.back().diffuse = to_vec3f({0.2 * i, 0.9 - 0.2 * i, 0.5});
  }
  scene.lights = {spot({0.5, 0.2, 2}, 1.0, 1.6)};
  return scene;
}

Image drawn(const std::vector<pass_t>& passes, std::vector<Rect> overlay = {}) {
  display();
  const scene_t scene = colourful();
  const SceneView view(scene, {}, Settings{});
  Renderer renderer(kWidth, kHeight, 256);
  Appearance appearance = view.appearance();
  appearance.passes = passes;
  renderer.load(view.geometries(), view.lighting(), {}, appearance);
  CHECK(renderer.take_warnings().empty());
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
  DrawList list = view.draw(poses, {});
  list.overlay = std::move(overlay);
  return draw(renderer, list);
}

pass_t pass(const std::string& shader, const std::string& name = "", float value = 0) {
  pass_t p{};
  p.shader = shader;
  if (name.empty()) return p;
  uniform_t u{};
  u.name = name, u.count = 1, u.values[0] = value;
  p.uniforms = {u};
  p.uniform_count = 1;
  return p;
}

Vector3d linear_at(const Image& image, int x, int y) {
  return image.at(std::clamp(x, 0, kWidth - 1), std::clamp(y, 0, kHeight - 1)).unaryExpr(&linear);
}
// ITU-R BT.709-6, item 3.2.
double luminance(const Vector3d& c) { return 0.2126 * c.x() + 0.7152 * c.y() + 0.0722 * c.z(); }

template <class Expected>
void compare(const Image& seen, double tolerance, Expected expected) {
  for (int y = 3; y < kHeight; y += 7)
    for (int x = 2; x < kWidth; x += 7) {
      const Vector3d e = expected(x, y);
      for (int c = 0; c < 3; ++c) {
        INFO("pixel " << x << ", " << y << ", channel " << c);
        REQUIRE(seen.at(x, y)[c] == Approx(srgb(e[c])).margin(tolerance));
      }
    }
}

}  // namespace

TEST_CASE("Greyscale removes the given share of colour and keeps luminance") {
  const float amount = GENERATE(1.0f, 0.4f, 0.0f);
  const Image before = drawn({});
  compare(drawn({pass("greyscale", "amount", amount)}), kTolerance, [&](int x, int y) -> Vector3d {
    const Vector3d c = linear_at(before, x, y);
    return (1 - amount) * c + amount * Vector3d::Constant(luminance(c));
  });
}

TEST_CASE("Blur is a Gaussian of its radius, in linear light") {
  // Samples at whole pixels, so that the filter of the sampler has no effect.
  const float radius = GENERATE(1.0f, 2.0f);
  const Image before = drawn({});
  compare(drawn({pass("blur", "radius", radius)}), kTolerance, [&](int x, int y) {
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    for (int j = -2; j <= 2; ++j)
      for (int i = -2; i <= 2; ++i) {
        const double w = std::exp(-0.5 * (i * i + j * j));
        sum += w * linear_at(before, x + i * static_cast<int>(radius), y + j * static_cast<int>(radius)),
            weights += w;
      }
    return Vector3d(sum / weights);
  });
}

TEST_CASE("Edges are the magnitude of Sobel's gradient of luminance") {
  const Image before = drawn({});
  // Rounding to eight bits errs by up to 0.004 in linear light, and eight values are added: dark edges are
  // accurate to that.
  const Image seen = drawn({pass("edges", "gain", 0.5f)});
  for (int y = 3; y < kHeight - 3; y += 5)
    for (int x = 3; x < kWidth - 3; x += 5) {
      const auto l = [&](int i, int j) { return luminance(linear_at(before, x + i, y + j)); };
      const double dx = l(1, -1) + 2 * l(1, 0) + l(1, 1) - l(-1, -1) - 2 * l(-1, 0) - l(-1, 1);
      const double dy = l(-1, 1) + 2 * l(0, 1) + l(1, 1) - l(-1, -1) - 2 * l(0, -1) - l(1, -1);
      REQUIRE(linear(seen.at(x, y).x()) == Approx(std::min(1.0, 0.5 * std::hypot(dx, dy))).margin(0.02));
      REQUIRE(seen.at(x, y).x() == seen.at(x, y).z());
    }
}

TEST_CASE("Passes are applied in their order") {
  const Image grey = drawn({pass("greyscale")}), edges = drawn({pass("edges")});
  CHECK(drawn({pass("greyscale", "amount", 0), pass("greyscale")}).rgba == grey.rgba);
  // Edges of the grey picture equal those of the coloured one except for rounding; a grey version of an edge
  // picture is unchanged.
  CHECK(drawn({pass("edges"), pass("greyscale")}).rgba == edges.rgba);
  CHECK(drawn({pass("edges"), pass("blur")}).rgba != drawn({pass("blur"), pass("edges")}).rgba);
}

TEST_CASE("Passes do not change text and marker") {
  Rect rect;
  rect.x = 10, rect.y = 20, rect.width = 30, rect.height = 30, rect.red = 1, rect.green = 0.5f;
  const Image image = drawn({pass("greyscale"), pass("blur")}, {rect});
  CHECK((image.at(10, 20) - Vector3d(255, 127.5, 0)).cwiseAbs().maxCoeff() <= 1);
  CHECK((image.at(39, 49) - Vector3d(255, 127.5, 0)).cwiseAbs().maxCoeff() <= 1);
}
