// Complete worlds: the dark room, typical Gazebo worlds, and a file with damage at every position.
#include <iostream>
#include <random>
#include <sstream>
#include <tactus/scene_t.hpp>

#include "lcmtypes/pointing.h"
#include "lcmtypes/vectors.h"
#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/assets/scene_receiver.h"
#include "sync/bus/decode.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
const std::string kRoom = source_dir() + "/sim_node/scenes/dark_room.sdf";
const std::string kData = source_dir() + "/tests/sim_node/scene/data/";

const BodyDef& body(const WorldDef& w, const std::string& name) {
  for (const BodyDef& b : w.bodies)
    if (b.name == name) return b;
  FAIL("no body " + name);
  return w.bodies.front();
}
}  // namespace

TEST_CASE("The dark room loads without a warning and has its documented content") {
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(kRoom, warnings);
  CHECK(warnings == std::vector<std::string>{});
  int moving = 0, universal = 0;
  for (const BodyDef& b : w.bodies) moving += !b.is_static && b.tool < 0;
  for (const JointDef& j : w.joints) universal += j.kind == JointKind::kUniversal;
  CHECK(moving < 30);
  CHECK(universal == 11);  // 22 degrees of freedom
  CHECK(w.meshes.size() == 1);
  CHECK(w.meshes[0].indices.size() / 3 < 3000);
  for (const ShapeDef& s : w.shapes) CHECK(s.material >= 0);
  for (const char* ball : {"steel_ball::link", "wooden_ball::link", "rubber_ball::link"}) CHECK(body(w, ball).pose.translation().z() > 0.1);
  CHECK(body(w, "steel_ball::link").mass_kg == Approx(7850 * 4.0 / 3 * EIGEN_PI * 0.025 * 0.025 * 0.025));
}

TEST_CASE("The fan of the dark room reaches the speed at which friction balances its torque") {
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(kRoom, warnings);
  for (const JointDef& j : w.joints)
    if (j.name == "fan::axle") CHECK((j.axes[0].motor_effort - j.axes[0].friction) / j.axes[0].damping == Approx(3.75));
}

TEST_CASE("The path of the hand is closed, stays in the room and has human speeds") {
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(kRoom, warnings);
  REQUIRE(w.tools.size() == 2);
  CHECK(steered_light(w.tools[0], w.lights) == -1);
  CHECK(steered_light(w.tools[1], w.lights) >= 0);  // the other hand points the lamp
  const auto& path = w.tools[0].waypoints;
  CHECK((to_eigen(path.front().position_m) - to_eigen(path.back().position_m)).norm() < 1e-9);
  const Eigen::AlignedBox3d room(Vector3d(-0.45, -0.6, -0.003), Vector3d(0.45, 0.6, 0.5));
  double fastest = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vector3d a = to_eigen(path[i].position_m), b = to_eigen(path[i + 1].position_m);
    CHECK(room.contains(a));
    fastest = std::max(fastest, (b - a).norm() / (path[i + 1].time_s - path[i].time_s));
  }
  CHECK(fastest < 0.75);
  CHECK(path.back().time_s < 25);
}

TEST_CASE("Every floor corner of the dark room is in the picture") {
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(kRoom, warnings);
  const double across = std::tan(w.camera_fov_rad / 2);
  for (const double x : {-0.45, 0.45})
    for (const double y : {-0.6, 0.6}) {
      const Vector3d p = w.camera.inverse() * Vector3d(x, y, 0);
      CHECK(std::abs(p.y()) < across * p.x());
      CHECK(std::abs(p.z()) < 0.75 * across * p.x());
    }
}

TEST_CASE("Typical Gazebo worlds load, and unsupported elements are reported") {
  std::vector<std::string> warnings;
  const WorldDef shapes = load_sdf(kData + "shapes.sdf", warnings);
  CHECK(shapes.bodies.size() == 6);
  CHECK(shapes.lights.size() == 1);
  CHECK(warnings.size() == 8);  // four plugins, gui, scene/shadows, scene/grid, contact sensor
  CHECK(body(shapes, "box::box_link").mass_kg == 1);

  warnings.clear();
  const WorldDef stack = load_sdf(kData + "stack_classic.world", warnings);
  CHECK(stack.bodies.size() == 6);
  CHECK(body(stack, "brick_4::link").pose.translation().z() == Approx(0.9));
  for (const std::string& w : warnings) CHECK_THAT(w, Catch::Contains("stack_classic.world:"));
  CHECK(warnings.size() == 6);

  warnings.clear();
  const WorldDef pendulum = load_sdf(kData + "double_pendulum.sdf", warnings);
  REQUIRE(pendulum.joints.size() == 3);
  CHECK(pendulum.joints[0].kind == JointKind::kFixed);
  CHECK((pendulum.joints[1].anchor_m - Vector3d(0, 0, 2.1)).norm() < 1e-9);
  CHECK((pendulum.joints[2].anchor_m - Vector3d(0.25, 1, 2.1)).norm() < 1e-6);
  CHECK(warnings.size() == 2);
}

TEST_CASE("The assets of every world pass the validation of the bus") {
  for (const std::string& file : {kRoom, kData + "shapes.sdf", kData + "stack_classic.world", kData + "double_pendulum.sdf"}) {
    INFO(file);
    std::vector<std::string> warnings;
    const auto assets = make_assets(load_sdf(file, warnings));
    CHECK(sync::decode_asset<scene_t>(assets[0].bytes));
    for (const auto& asset : assets) CHECK(asset.bytes.size() <= sync::SceneReceiver::kMaxAssetBytes);
  }
}

TEST_CASE("A damaged scene file is rejected or repaired and never ends the process") {
  const std::string whole = world(R"(<gravity>0 0 -9.8</gravity><light name="s" type="spot"><pose>0 0 1 0 0 0</pose></light>
<tactus:camera pose="0 0 1 0 0 0"/><tactus:tool name="h"><tactus:waypoint time="1" position="0 0 0"/></tactus:tool>
<model name="m"><pose>0 0 1 0 0 0</pose><link name="a"><inertial><mass>1</mass></inertial><collision name="c"><geometry><box>
<size>1 1 1</size></box></geometry></collision></link><link name="b"/><joint name="j" type="revolute"><parent>a</parent><child>b
</child><axis><xyz>0 0 1</xyz></axis></joint></model>)");
  SceneFile file;
  std::mt19937 random(7);
  int loaded = 0, rejected = 0;
  for (int i = 0; i < 400; ++i) {
    std::string text = whole;
    const std::size_t at = random() % text.size();
    switch (random() % 4) {
      case 0: text.resize(at); break;
      case 1: text[at] = static_cast<char>(random()); break;
      case 2: text.erase(at, 1 + random() % 30); break;
      case 3: {
        const char* inserts[] = {"nan", "-", "1e999", "<", "<link/>", "<include/>", "&", "\0x", "<model name='m'/>"};
        text.insert(at, inserts[random() % 9]);
        break;
      }
    }
    INFO(text);
    file.write("scene.sdf", text);
    const std::string sentence = file.load_error();
    (sentence.empty() ? loaded : rejected) += 1;
    if (!sentence.empty()) CHECK_THAT(sentence, Catch::StartsWith("scene.sdf"));
  }
  CHECK(rejected > 125);
  CHECK(loaded > 25);
}
