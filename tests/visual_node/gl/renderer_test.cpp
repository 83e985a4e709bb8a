#include "visual_node/gl/renderer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "tests/visual_node/support/offscreen.h"
#include "tests/visual_node/support/read_marker.h"

using namespace tactus;
using namespace tactus::visual;
using namespace tactus::test;

TEST_CASE("The centre of a lit sphere has the colour of the formula") {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {2, 0, 0}), shape_def_t::SPHERE, {0.5, 0, 0});
  visual_def_t& v = scene.visuals[0];
  v.diffuse = to_vec3f({0.6, 0.3, 0.1});
  v.specular = test::grey(0.2f);
  v.ambient = test::grey(0.5f);
  v.emissive = to_vec3f({0, 0, 0.05});
  scene.ambient = test::grey(0.1f);
  light_def_t lamp = test::spot({0, 0, 1.5}, 1, 1);
  lamp.kind = light_def_t::POINT;
  lamp.specular = test::grey(1);
  lamp.attenuation_quadratic = 0.2f;
  lamp.casts_shadow = 0;
  scene.lights = {lamp};
  const Eigen::Vector3d colour = render(scene).at(kWidth / 2, kHeight / 2);

  // The surface point nearest to the eye is (1.5, 0, 0), its normal (-1, 0, 0), which is also the direction to
  // the eye.
  const Eigen::Vector3d to(-1.5, 0, 1.5);
  const double d = to.norm(), cosine = 1.5 / d, strength = 1 / (1 + 0.2 * d * d);
  const double t = cosine;  // of the reflected ray and the direction to the eye: 2 (n l) (n v) - l v with v = n
  const double lobe = t / (16 - 16 * t + t);
  for (int c = 0; c < 3; ++c) {
    const double diffuse = std::array{0.6, 0.3, 0.1}[static_cast<std::size_t>(c)], emissive = c == 2 ? 0.05 : 0;
    const double linear = emissive + 0.5 * 0.1 * 0.75 + strength * (diffuse * cosine + 0.2 * lobe);
    CHECK(colour[c] == Approx(srgb(linear)).margin(kTolerance));
  }
}

TEST_CASE("A spot lights only its cone") {
  scene_t scene = floor_from_above(4);
  scene.lights = {test::spot({0, 0, 2}, 0.6, 0.8)};
  const Image image = render(scene);
  const auto at = [&](double angle_rad) {
    return image.at(kWidth / 2 + static_cast<int>(2 * std::tan(angle_rad) * scale_px(4)), kHeight / 2).x();
  };
  CHECK(at(0) == Approx(srgb(0.5)).margin(kTolerance));
  CHECK(at(0.2) == Approx(srgb(0.5 * std::cos(0.2))).margin(kTolerance));
  CHECK(at(0.45) == 0);
  CHECK(at(0.6) == 0);
}

TEST_CASE("Lamps of every kind and number are drawn") {
  scene_t scene = floor_from_above(4);
  light_def_t sun = test::spot({0, 0, 2}, 1, 1);
  sun.kind = light_def_t::DIRECTIONAL;
  sun.diffuse = test::grey(0.1f);
  light_def_t soft = test::spot({0, 0, 2}, 0.2, 1.2);
  soft.falloff = 2;
  soft.diffuse = test::grey(0.2f);
  light_def_t near = test::spot({0, 0, 2}, 1, 1);
  near.kind = light_def_t::POINT;
  near.range_m = 1;  // does not reach the floor
  scene.lights = {sun, soft, near, sun, sun};
  const Image image = render(scene);
  CHECK(image.at(kWidth / 2, kHeight / 2).x() == Approx(srgb(0.5 * (0.3 + 0.2))).margin(kTolerance));
  const double angle = 0.4, inside = (std::cos(angle) - std::cos(0.6)) / (std::cos(0.1) - std::cos(0.6));
  const double linear = 0.5 * (0.3 + 0.2 * inside * inside * std::cos(angle));
  const int x = kWidth / 2 + static_cast<int>(std::lround(2 * std::tan(angle) * scale_px(4)));
  CHECK(image.at(x, kHeight / 2).x() == Approx(srgb(linear)).margin(kTolerance));
}

TEST_CASE("A ball under a spot casts its shadow at the computed position") {
  scene_t scene = floor_from_above(6);
  test::add_visual(scene, test::add_body(scene, {0.3, 0, 1}), shape_def_t::SPHERE, {0.2, 0, 0});
  scene.lights = {test::spot({-1, 0, 3}, 1.2, 1.4)};
  scene.lights[0].direction = to_vec3(Eigen::Vector3d(0.5, 0, -1).normalized());
  const auto floor_at = [&](const Image& image, double x) {  // picture up is +x
    return image.at(kWidth / 2, kHeight / 2 - static_cast<int>(std::lround(x * scale_px(6)))).x();
  };
  // The ray from the lamp through the ball's centre meets the floor at -1 + 1.3 * 3 / 2 = 0.95.
  const Image with = render(scene);
  CHECK(floor_at(with, 0.95) == 0);
  CHECK(floor_at(with, 0.95 + 0.6) > 20);
  CHECK(floor_at(with, -0.3) > 20);
  SECTION("there is no shadow when shadows are off") {
    Settings settings;
    settings.shadows = false;
    CHECK(floor_at(render(scene, settings), 0.95) > 20);
  }
}

TEST_CASE("A lit floor does not shadow itself") {
  scene_t scene = floor_from_above(4);
  test::add_visual(scene, 0, shape_def_t::BOX, {6, 6, 0.1});  // a box casts a shadow, a plane does not
  scene.lights = {test::spot({0, 0, 2}, 1.4, 1.5)};
  const Image image = render(scene);
  for (int x = kWidth / 2 - 100; x < kWidth / 2 + 100; ++x)
    for (const int y : {200, 240, 280}) CHECK(image.at(x, y).x() > 150);
}

TEST_CASE("The marker is decoded from a drawn picture") {
  std::vector<Rect> overlay;
  const std::vector<std::int64_t> events{0x123456789abcdef0, 17};
  append_marker(overlay, 4711, events, kHeight);
  const Image image = render(test::empty_scene(), {}, overlay);
  std::vector<std::uint8_t> luma;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) luma.push_back(static_cast<std::uint8_t>(image.at(x, y).y()));
  const auto first = read_marker(luma, kWidth, kHeight, 0), second = read_marker(luma, kWidth, kHeight, 1);
  REQUIRE(first);
  REQUIRE(second);
  CHECK(first->frame == 4711);
  CHECK(first->event == 0x9abcdef0);
  CHECK(second->event == 17);
}

namespace {
// Sunlight along `direction`, white.
light_def_t sun(const Eigen::Vector3d& direction) {
  light_def_t lamp = test::spot({0, 0, 2}, 1, 1);
  lamp.kind = light_def_t::DIRECTIONAL;
  lamp.direction = to_vec3(direction.normalized());
  lamp.casts_shadow = 0;
  return lamp;
}
const Eigen::Vector3d kSun(0.6, 0.3, -1);
constexpr double kWave_m = 1, kHeight_m = 0.08;
const HeightMaps kSine{{1, test::sine_map(256, 4)}};

// Lambert's value for a grey surface of normal n, in 8 bits.
double lambert(const Eigen::Vector3d& n) {
  return srgb(0.5 * std::max(0.0, -n.normalized().dot(kSun.normalized())));
}
double slope(double u_m) {  // derivative of kHeight_m / 2 sin(2 pi u / kWave_m)
  return std::numbers::pi * kHeight_m / kWave_m * std::cos(2 * std::numbers::pi * u_m / kWave_m);
}

// A rotated and moved floor, seen by a camera that moves with it.
scene_t rough_floor(const Eigen::Isometry3d& body) {
  scene_t scene = floor_from_above(4);
  scene.lights = {sun(kSun)};
  scene.materials = {test::rough(1, kWave_m, kWave_m, kHeight_m)};
  scene.visuals[0].shape.material = 0;
  scene.bodies[0].pose = to_pose(body);
  scene.camera = to_pose(body * to_eigen(scene.camera));
  return scene;
}
}  // namespace

TEST_CASE("A relief of waves is shaded by Lambert's law of its slopes") {
  const double turned_rad = GENERATE(0.0, 0.7);
  const Eigen::Isometry3d body(Eigen::Translation3d(0.3, -0.2, 0) *
                               Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitZ()));
  const Image image = render(rough_floor(body), {}, {}, kSine);
  double darkest = 255, brightest = 0;
  for (int y = 20; y < kHeight - 20; ++y) {
    // Picture up is +x of the body; the middle of the picture is its origin.
    const double x = (kHeight / 2 - (y + 0.5)) / scale_px(4), level = image.at(kWidth / 2, y).x();
    const Eigen::Vector3d n = body.linear() * Eigen::Vector3d(-slope(x), 0, 1);
    REQUIRE(level == Approx(lambert(n)).margin(kTolerance));
    darkest = std::min(darkest, level), brightest = std::max(brightest, level);
  }
  // Both flanks of a wave are in the picture, which is 3.3 m high.
  const auto extreme = [&](double s) { return lambert(body.linear() * Eigen::Vector3d(s, 0, 1)); };
  const auto [low, high] = std::minmax({extreme(-slope(0)), extreme(slope(0))});
  CHECK(high - low > 20);
  CHECK(darkest == Approx(low).margin(kTolerance));
  CHECK(brightest == Approx(high).margin(kTolerance));
}

TEST_CASE("Each side of a box is shaded along its own two axes") {
  // A cube of 2 m, its sides seen from a distance of 3 m.
  const int across = GENERATE(0, 1, 2), sign = GENERATE(-1, 1);
  const Eigen::Vector3d outward = sign * Eigen::Vector3d::Unit(across);
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {0, 0, 0}), shape_def_t::BOX, {2, 2, 2});
  scene.materials = {test::rough(1, kWave_m, kWave_m, kHeight_m)};
  scene.visuals[0].shape.material = 0;
  const Eigen::Vector3d u = Eigen::Vector3d::Unit((across + 1) % 3);
  Eigen::Matrix3d camera;
  camera << -outward, -sign * u, -outward.cross(-sign * u);  // looks along x; y is to the left, z up
  scene.camera = to_pose(Eigen::Isometry3d(Eigen::Translation3d(4 * outward) * Eigen::Quaterniond(camera)));
  const Eigen::Vector3d light = outward + 0.6 * u;  // to the lamp
  scene.lights = {sun(-light)};
  const Image image = render(scene, {}, {}, kSine);
  for (int x = kWidth / 2 - 120; x < kWidth / 2 + 120; ++x) {
    const double at_u = sign * (x + 0.5 - kWidth / 2) / scale_px(3);
    const Eigen::Vector3d n = (outward - slope(at_u) * u).normalized();
    REQUIRE(image.at(x, kHeight / 2).x() == Approx(srgb(0.5 * n.dot(light.normalized()))).margin(kTolerance));
  }
}

TEST_CASE("A surface without relief looks the same in a scene with reliefs") {
  scene_t scene = rough_floor(Eigen::Isometry3d::Identity());
  scene.materials.push_back(test::rough(0, 0, 0, 0));
  test::add_visual(scene, test::add_body(scene, {0, 0, 0.5}), shape_def_t::SPHERE, {0.4, 0, 0});
  test::add_visual(scene, test::add_body(scene, {0.6, 0.8, 0.2}), shape_def_t::BOX, {0.4, 0.4, 0.4});
  scene.visuals[1].shape.material = 1;
  scene.visuals[1].specular = scene.visuals[2].specular = test::grey(0.5f);
  const Image with = render(scene, {}, {}, kSine);
  const Image without = render(scene);  // the height map is missing
  scene.materials[0].bump_asset = 0;
  CHECK(render(scene).rgba == without.rgba);
  int different = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) different += with.at(x, y) != without.at(x, y);
  CHECK(different > kWidth * kHeight / 2);
  // The ball and the top of the box are identical to the bit.
  const double ball_px = 0.4 * scale_px(3.5) - 2;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (std::hypot(x - kWidth / 2, y - kHeight / 2) < ball_px) REQUIRE(with.at(x, y) == without.at(x, y));
  const int box_x = kWidth / 2 - static_cast<int>(0.8 * scale_px(3.6)),
            box_y = kHeight / 2 - static_cast<int>(0.6 * scale_px(3.6));
  for (int y = box_y - 20; y < box_y + 20; ++y)
    for (int x = box_x - 20; x < box_x + 20; ++x) REQUIRE(with.at(x, y) == without.at(x, y));
  SECTION("a relief without heights is smooth") {
    HeightMap flat = test::sine_map(16, 16);
    std::fill(flat.levels.begin(), flat.levels.end(), std::uint16_t{1234});
    scene.materials[0].bump_asset = 1;
    const Image level = render(scene, {}, {}, {{1, flat}});
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) REQUIRE((level.at(x, y) - without.at(x, y)).cwiseAbs().maxCoeff() <= 1);
  }
}

TEST_CASE(
    "An error in a part of a shader is reported with its file and line") {
  display();
  const std::vector<ShaderPiece> vertex{{"a.vert", "void main() { gl_Position = vec4(0); }"}};
  const auto with = [&](const std::string& mine) {
    Program(vertex,
            {{"first.glsl", "out vec4 colour;\nvec4 shade();\n"},
             {"mine.frag", mine},
             {"end.frag", "\nvoid main() { float unset; colour = unset * shade(); }"}},
            "#define X 1\n");
  };
  CHECK_NOTHROW(with("vec4 shade() { return vec4(1); }"));
  CHECK_THROWS_WITH(with("\nvec4 shade() { return vec4(1) }"),
                    Catch::Contains("mine.frag:2: error"));  // syntax error
  CHECK_THROWS_WITH(
      with("\n\nvec4 shade() { return lamp_of_my_own; }"),  // semantic error
      Catch::Contains("mine.frag:3: error") && Catch::Contains("lamp_of_my_own") && !Catch::Contains("warning"));
  CHECK_THROWS_WITH(with("void main() {}"), Catch::Contains("end.frag:2: error"));
  CHECK_THROWS_WITH(with("vec4 shade() {\n a = 1;\n b = 1;\n c = 1;\n d = 1;\n return vec4(1); }"),
                    Catch::Contains("mine.frag:2") && !Catch::Contains("mine.frag:5") && Catch::EndsWith(" more"));
}

TEST_CASE("A shader that does not compile is reported with file and line") {
  display();
  const std::string good = "#version 330 core\nvoid main() { gl_Position = vec4(0); }\n";
  const std::string bad = "#version 330 core\nout vec4 colour;\nvoid main() {\n  colour = nothing;\n}\n";
  CHECK_THROWS_WITH(Program("a.vert", good, "b.frag", bad), Catch::Contains("b.frag:4"));
  CHECK_THROWS_WITH(Program("a.vert", good, "b.frag", bad, "#define X 1\n#define Y 2\n"),
                    Catch::Contains("b.frag:4"));
  CHECK_THROWS_WITH(Program("nowhere"), Catch::Contains("nowhere.vert"));
}
