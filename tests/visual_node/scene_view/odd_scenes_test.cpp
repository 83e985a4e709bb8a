// Unusual scenes: empty, crowded, with bodies of zero or extreme size, with invalid poses.
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/visual_node/support/offscreen.h"

using namespace tactus;
using namespace tactus::visual;
using namespace tactus::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::vector<Eigen::Isometry3d> poses_of(const scene_t& scene) {
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
  return poses;
}

Image render_at(const scene_t& scene, const std::vector<Eigen::Isometry3d>& poses) {
  display();
  const Settings settings;
  const SceneView view(scene, {}, settings, {});
  Renderer renderer(kWidth, kHeight, settings.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  Image image = draw(renderer, view.draw(poses, {}));
  CHECK(display().loss_reason().empty());
  return image;
}

// Seen from 2 m above, lit by a spot with a shadow.
scene_t lit_floor() {
  scene_t scene = floor_from_above(2);
  scene.lights.push_back(spot({0, 0, 1.9}, 1, 1.2));
  return scene;
}

}  // namespace

TEST_CASE("An empty scene shows its background") {
  scene_t scene = empty_scene();
  scene.background = grey(0.25f);
  REQUIRE(valid(scene));
  const Image image = render(scene);
  for (const auto& [x, y] :
       {std::pair(0, 0), std::pair(kWidth - 1, kHeight - 1), std::pair(kWidth / 2, kHeight / 2)})
    CHECK((image.at(x, y) - Eigen::Vector3d::Constant(srgb(0.25))).cwiseAbs().maxCoeff() <= kTolerance);
}

TEST_CASE("Three thousand bodies are drawn at their positions") {
  scene_t scene = floor_from_above(2);
  scene.visuals.clear();  // no floor: every lit pixel is a body
  scene.ambient = grey(1);
  // A grid of 60 x 50 balls of 4 mm, 30 mm apart; picture up is +x, and picture left +y.
  constexpr int kColumns = 60, kRows = 50;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const double right_m = 0.03 * (i % kColumns - 29.5), up_m = 0.03 * (i / kColumns - 24.5);
    add_visual(scene, add_body(scene, {up_m, -right_m, 0}), shape_def_t::SPHERE, {0.004, 0, 0});
  }
  scene.body_count = static_cast<int>(scene.bodies.size());
  const Image image = render(scene);
  const double px = scale_px(2);
  int missing = 0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int x = static_cast<int>(std::floor(kWidth / 2 + px * 0.03 * (i % kColumns - 29.5)));
    const int y = static_cast<int>(std::floor(kHeight / 2 - px * 0.03 * (i / kColumns - 24.5)));
    if (x < 2 || y < 2 || x > kWidth - 3 || y > kHeight - 3) continue;
    missing += image.at(x, y).maxCoeff() < 20;
  }
  CHECK(missing == 0);
}

TEST_CASE("A body with an extreme pose is invisible and does not affect others") {
  scene_t with = lit_floor();
  const scene_t without = with;
  const int body = add_body(with, {0, 0, 0.2});
  for (const int kind : {shape_def_t::BOX, shape_def_t::SPHERE, shape_def_t::CYLINDER})
    add_visual(with, body, kind, {0.1, 0.1, 0.1});
  const Image clean = render(without);
  REQUIRE(clean.at(kWidth / 2, kHeight / 2).maxCoeff() > 20);
  auto poses = poses_of(with);
  CHECK(render_at(with, poses).rgba != clean.rgba);
  for (const double odd : {kNan, kInfinite, 1e30}) {
    CAPTURE(odd);
    poses.back().translation() = Eigen::Vector3d::Constant(odd);
    CHECK(render_at(with, poses).rgba == clean.rgba);
  }
}

TEST_CASE("Bodies of any size and position are drawn without errors") {
  std::mt19937 random(7);
  const double sizes[] = {0, 1e-12, 1e-3, 1, 1e6, 1e9}, places[] = {0, -1e-9, 0.3, -5, 1e6, -1e9};
  const auto any = [&](const auto& list) { return list[random() % std::size(list)]; };
  for (int round = 0; round < 40; ++round) {
    scene_t scene = lit_floor();
    for (int i = 0; i < 12; ++i) {
      const int body = add_body(scene, {any(places), any(places), any(places)});
      add_visual(scene, body, static_cast<int>(random() % 7), {any(sizes), any(sizes), any(sizes)});
    }
    scene.body_count = static_cast<int>(scene.bodies.size());
    scene.visual_count = static_cast<int>(scene.visuals.size());
    const Image odd = render_at(scene, poses_of(scene));
    CHECK(odd.rgba.size() == static_cast<std::size_t>(kWidth * kHeight * 4));
  }
  // The next picture is as usual.
  const Image a = render(lit_floor());
  CHECK(a.at(kWidth / 2, kHeight / 2).maxCoeff() > 20);
}

TEST_CASE("Poses and sizes that are not finite are rejected") {
  scene_t scene = lit_floor();
  scene.body_count = static_cast<int>(scene.bodies.size());
  scene.visual_count = static_cast<int>(scene.visuals.size());
  scene.light_count = static_cast<int>(scene.lights.size());
  REQUIRE(valid(scene));
  for (const double odd : {kNan, kInfinite, -kInfinite, 1e300}) {
    CAPTURE(odd);
    scene_t size = scene, pose = scene, camera = scene, light = scene;
    size.visuals[0].shape.size_m.x = odd;
    pose.bodies[0].pose.position_m.z = odd;
    camera.camera.orientation.w = odd;
    light.lights[0].intensity = static_cast<float>(odd);
    for (const scene_t& bad : {size, pose, camera, light}) CHECK_FALSE(valid(bad));

    world_state_t world{};
    world.header.run_id = world.header.incarnation = 1;
    world.pages = 1;
    world.count = 1;
    world.bodies.resize(1);
    world.bodies[0].orientation.w = 1;
    REQUIRE(valid(world));
    world.bodies[0].position_m.x = odd;
    CHECK_FALSE(valid(world));
    tool_state_t head{};
    head.header.run_id = head.header.incarnation = 1;
    head.device.orientation.w = head.proxy.orientation.w = 1;
    REQUIRE(valid(head));
    head.device.orientation.x = odd;
    CHECK_FALSE(valid(head));
  }
}

TEST_CASE("The smallest and largest picture sizes of the settings are drawn") {
  display();
  const scene_t scene = lit_floor();
  for (const auto& [width, height] : {std::pair(320, 240), std::pair(4096, 240), std::pair(320, 4096)}) {
    Settings settings;
    settings.width = width, settings.height = height;
    const SceneView view(scene, {}, settings, {});
    Renderer renderer(view.width(), view.height(), settings.shadow_size);
    renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
    const DrawList list = view.draw(poses_of(scene), {});
    renderer.draw_scene(list);
    renderer.draw_flashes_and_overlay(list);
    CHECK(renderer.wait());
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    renderer.picture().read(rgba);
    const std::size_t middle = (static_cast<std::size_t>(height) / 2 * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(width) / 2) *
                               4;
    CHECK(rgba[middle] > 20);
  }
}
