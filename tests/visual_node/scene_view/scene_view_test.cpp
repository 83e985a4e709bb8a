#include "visual_node/scene_view/scene_view.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "tests/visual_node/support/test_scene.h"
#include "visual_node/scene_view/lighting.h"

using namespace tactus;
using namespace tactus::visual;

namespace {
int instances(const std::vector<Batch>& batches) {
  int sum = 0;
  for (const Batch& b : batches) sum += b.count;
  return sum;
}
}  // namespace

TEST_CASE("A scene has one instance for each visible shape at its body") {
  scene_t scene = test::empty_scene();
  const int ball = test::add_body(scene, {1, 2, 3});
  test::add_visual(scene, ball, shape_def_t::SPHERE, {0.1, 0, 0});
  const SceneView view(scene, {}, Settings{});
  std::vector<Eigen::Isometry3d> poses{Eigen::Isometry3d(Eigen::Translation3d(4, 5, 6))};
  const DrawList list = view.draw(poses, {});
  REQUIRE(list.instances.size() == 1);
  CHECK(list.instances[0].position.head<3>().isApprox(Eigen::Vector3f(4, 5, 6)));
  CHECK(list.instances[0].scale.head<3>().isApprox(Eigen::Vector3f(0.1f, 0.1f, 0.1f)));
  CHECK(instances(list.opaque) == 1);

  SECTION("a shape with an offset rotates with its body") {
    scene.visuals[0].shape.pose.position_m.x = 1;
    poses[0].rotate(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
    const DrawList turned = SceneView(scene, {}, Settings{}).draw(poses, {});
    CHECK(turned.instances[0].position.head<3>().isApprox(Eigen::Vector3f(4, 6, 6)));
  }
  SECTION("all shapes of one kind are one batch") {
    for (int i = 0; i < 50; ++i) test::add_visual(scene, ball, shape_def_t::BOX, {1, 1, 1});
    const DrawList many = SceneView(scene, {}, Settings{}).draw(poses, {});
    CHECK(many.opaque.size() == 2);
    CHECK(instances(many.opaque) == 51);
  }
}

TEST_CASE("Batches contain every instance exactly once and only existing geometries") {
  scene_t scene = test::empty_scene();
  for (int i = 0; i < 40; ++i) {
    const int body = test::add_body(scene, {2.0 + i, 0.1 * i, 0});
    test::add_visual(scene, body, i % 5, {0.2, 0.2, 0.3});
    scene.visuals.back().alpha = i % 7 == 0 ? 0.5f : 1.0f;
  }
  const SceneView view(scene, {}, Settings{});
  std::vector<Eigen::Isometry3d> poses(scene.bodies.size(), Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].translation().x() = 2.0 + static_cast<double>(i);
  const DrawList list = view.draw(poses, {});
  std::multiset<int> named;
  for (const auto* batches : {&list.opaque, &list.translucent})
    for (const Batch& b : *batches) {
      CHECK(b.geometry < static_cast<int>(view.geometries().size()));
      for (int i = 0; i < b.count; ++i) named.insert(b.first + i);
    }
  REQUIRE(named.size() == 40);
  for (int i = 0; i < 40; ++i) CHECK(named.count(i) == 1);

  SECTION("translucent shapes are last, from far to near") {
    float before = 1e9f;
    for (const Batch& b : list.translucent)
      for (int i = b.first; i < b.first + b.count; ++i) {
        const Instance& instance = list.instances[static_cast<std::size_t>(i)];
        CHECK(instance.diffuse.w() < 1);
        CHECK(instance.position.x() <= before);
        before = instance.position.x();
      }
  }
}

TEST_CASE("The number of edges of a round shape follows its size on the screen") {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {0, 0, 0}), shape_def_t::SPHERE, {0.1, 0, 0});
  const SceneView view(scene, {}, Settings{});
  std::set<std::size_t> seen;
  std::size_t before = 0;
  for (const double distance_m : {50.0, 2.0, 0.4}) {
    const std::vector<Eigen::Isometry3d> pose{Eigen::Isometry3d(Eigen::Translation3d(distance_m, 0, 0))};
    const std::size_t triangles =
        view.geometries()[static_cast<std::size_t>(view.draw(pose, {}).opaque[0].geometry)].indices.size();
    CHECK(triangles > before);
    before = triangles;
  }
}

TEST_CASE("A tool is drawn solid at its proxy and as a ghost at its device") {
  scene_t scene = test::empty_scene();
  test::add_tool(scene, 0.02);
  const SceneView view(scene, {}, Settings{});
  const std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
  ToolPose tool{true, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -0.1)),
                Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.02))};
  DrawList list = view.draw(poses, std::span(&tool, 1));
  REQUIRE(instances(list.opaque) == 1);
  REQUIRE(instances(list.translucent) == 1);
  CHECK(list.instances[static_cast<std::size_t>(list.opaque[0].first)].position.z() == Approx(0.02f));
  CHECK(list.instances[static_cast<std::size_t>(list.opaque[0].first)].scale.x() == Approx(0.02f));
  CHECK(list.instances[static_cast<std::size_t>(list.translucent[0].first)].position.z() == Approx(-0.1f));

  SECTION("a tool without messages is drawn at its simulated pose without a ghost") {
    tool.known = false;
    list = view.draw(poses, std::span(&tool, 1));
    CHECK(instances(list.opaque) == 1);
    CHECK(instances(list.translucent) == 0);
    CHECK(list.instances[0].position.z() == 0);
  }
}

TEST_CASE("A shape with a missing mesh is drawn as a magenta box and reported once") {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {0, 0, 0}), shape_def_t::MESH, {1, 1, 1});
  scene.visuals[0].shape.mesh_hash = 42;
  scene.visuals[0].shape.name = "kettle";
  const SceneView view(scene, {}, Settings{});
  REQUIRE(view.warnings().size() == 1);
  CHECK_THAT(view.warnings()[0], Catch::Contains("kettle") && Catch::Contains("magenta"));
  const std::vector<Eigen::Isometry3d> pose{Eigen::Isometry3d(Eigen::Translation3d(2, 1, 0))};
  const DrawList list = view.draw(pose, {});
  REQUIRE(list.instances.size() == 1);
  CHECK(list.opaque[0].geometry == 1);  // the box
  CHECK(list.instances[0].position.head<3>().isApprox(Eigen::Vector3f(2, 1, 0)));
  // It glows, so that it is visible in the dark.
  CHECK(list.instances[0].emissive.head<3>() == Eigen::Vector3f(1, 0, 1));
}

TEST_CASE("geometry=physics draws the collision shapes, each body in its own colour") {
  scene_t scene = test::empty_scene();
  for (int i = 0; i < 3; ++i) {
    const int body = test::add_body(scene, {2, 0.3 * i, 0});
    test::add_visual(scene, body, shape_def_t::BOX, {0.1, 0.1, 0.1});
    for (int k = 0; k < 2; ++k) {
      shape_def_t shape = scene.visuals.back().shape;
      shape.kind = shape_def_t::SPHERE;
      scene.shapes.push_back(shape);
    }
  }
  const std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
  Settings settings;
  CHECK(SceneView(scene, {}, settings).draw(poses, {}).instances.size() == 3);
  settings.geometry = std::string("physics");
  const DrawList list = SceneView(scene, {}, settings).draw(poses, {});
  REQUIRE(list.instances.size() == 6);
  for (const Batch& b : list.opaque) CHECK(b.geometry >= 2);  // balls, no boxes
  std::set<std::array<float, 3>> colours;
  for (const Instance& i : list.instances) colours.insert({i.diffuse.x(), i.diffuse.y(), i.diffuse.z()});
  CHECK(colours.size() == 3);
}

TEST_CASE(
    "The spot factor falls from 1 at the inner angle to 0 at the outer one, linear in the cosine") {
  const light_def_t lamp = test::spot({0, 0, 2}, 0.6, 1.0);
  const Light l = make_light(lamp);
  const auto inside = [&](double angle) { return std::cos(angle) * l.cone.x() + l.cone.y(); };
  CHECK(inside(0.3) == Approx(1).margin(1e-4));
  CHECK(inside(0.5) == Approx(0).margin(1e-4));
  CHECK(inside(std::acos((std::cos(0.3) + std::cos(0.5)) / 2)) == Approx(0.5).margin(1e-4));
}

TEST_CASE(
    "A spot light with the name of a tool points at the tool, also with its shadow") {
  scene_t scene = test::empty_scene();
  scene.lights = {test::spot({5, 0, 2}, 0.6, 1.0), test::spot({0, 0, 2}, 0.6, 1.0)};
  scene.lights[0].casts_shadow = 0;
  scene.lights[1].name = "lamp";
  test::add_tool(scene, 0.005);
  scene.tools[0].name = "lamp";
  const SceneView view(scene, {}, Settings{});
  std::vector<ToolPose> tools(1);
  const std::vector<Eigen::Isometry3d> bodies(1, Eigen::Isometry3d::Identity());
  const auto unmoved = view.draw(bodies, tools);
  CHECK(unmoved.instances.empty());
  CHECK(unmoved.lighting.lights[1].direction == view.lighting().lights[1].direction);
  tools[0].known = true;
  tools[0].device.translation() = Eigen::Vector3d(3, 1, 0.5);
  const auto aimed = view.draw(bodies, tools).lighting;
  const Eigen::Vector3f wanted = Eigen::Vector3f(3, 1, -1.5).normalized();
  CHECK((aimed.lights[1].direction.head<3>() - wanted).norm() < 1e-6f);
  CHECK(aimed.lights[0].direction == unmoved.lighting.lights[0].direction);
  REQUIRE(aimed.shadow_light == 1);
  const Eigen::Vector4f c = aimed.shadow_clip * Eigen::Vector4f(3, 1, 0.5, 1);
  CHECK(std::max(std::abs(c.x()), std::abs(c.y())) / c.w() < 1e-5f);
  // At the lamp itself there is no direction.
  tools[0].device.translation() = Eigen::Vector3d(0, 0, 2);
  CHECK(view.draw(bodies, tools).lighting.lights[1].direction == unmoved.lighting.lights[1].direction);
}

TEST_CASE("The first spot that casts shadows has the shadow map, which covers its cone") {
  scene_t scene = test::empty_scene();
  light_def_t sun = test::spot({0, 0, 2}, 1, 1);
  sun.kind = light_def_t::DIRECTIONAL;
  scene.lights = {sun, test::spot({0, 0, 2}, 0.6, 1.0), test::spot({1, 0, 2}, 0.6, 1.0)};
  Lighting lighting = make_lighting(scene, Settings{});
  CHECK(lighting.shadow_light == 1);
  const auto on_map = [&](double x) {
    const Eigen::Vector4f c = lighting.shadow_clip * Eigen::Vector4f(static_cast<float>(x), 0, 0, 1);
    return std::max(std::abs(c.x()), std::abs(c.y())) / c.w();
  };
  CHECK(on_map(0) < 1e-5f);
  CHECK(on_map(2 * std::tan(0.5)) < 1);  // the edge of the outer cone
  CHECK(on_map(2 * std::tan(0.53)) > 1);

  SECTION("there is no shadow map when shadows are off") {
    Settings settings;
    settings.shadows = false;
    CHECK(make_lighting(scene, settings).shadow_light == -1);
  }
  SECTION("the number of lamps is limited to that of the shader") {
    scene.lights.resize(20, sun);
    CHECK(make_lighting(scene, Settings{}).lights.size() == kMaxLights);
  }
}
