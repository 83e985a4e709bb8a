// Frames: relative_to, attached_to, expressed_in, placement_frame, canonical links, scopes and circles.
#include "sim_node/scene/sdf/frames.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {

constexpr double kNear = 1e-12;
const std::string kQuarter = "1.5707963267948966";

Vector3d place_of(const WorldDef& w, const std::string& name) {
  for (const BodyDef& body : w.bodies)
    if (body.name == name) return body.pose.translation();
  FAIL("no body " << name);
  return {};
}

std::string error_of(const std::string& inside) {
  SceneFile file(world(inside));
  return file.load_error();
}

}  // namespace

TEST_CASE("A pose is relative to a link, a joint, a frame or a nested model, in any order and through scopes") {
  SceneFile file(world("<frame name='f'><pose>1 0 0 0 0 " + kQuarter + "</pose></frame>"
                       "<model name='a'><pose relative_to='b::tip'>0 0 1 0 0 0</pose><link name='l'/></model>"
                       "<model name='b'><pose relative_to='f'>1 0 0 0 0 0</pose><link name='l'><pose relative_to='g'>0 1 0 0 0 0</pose></link>"
                       "<frame name='g' attached_to='tip'><pose relative_to='j'>0 0 2 0 0 0</pose></frame>"
                       "<link name='tip'><pose>1 0 0 0 0 0</pose></link>"
                       "<link name='end'><pose relative_to='n::inner'>0 0 5 0 0 0</pose></link>"
                       "<model name='n'><pose relative_to='tip'>0 3 0 0 0 0</pose><link name='inner'><pose>0 0 1 0 0 0</pose></link></model>"
                       "<joint name='j' type='fixed'><parent>l</parent><child>tip</child><pose>0 0 0.5 0 0 0</pose></joint></model>"));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  // Frame f turns x to y: b is at (1, 1, 0) and turned.
  CHECK((place_of(w, "b::tip") - Vector3d(1, 2, 0)).norm() < kNear);
  CHECK((place_of(w, "b::l") - Vector3d(0, 2, 2.5)).norm() < kNear);  // tip + 2.5 z + y, which is -x
  CHECK((place_of(w, "a::l") - Vector3d(1, 2, 1)).norm() < kNear);
  CHECK((place_of(w, "b::n::inner") - Vector3d(-2, 2, 1)).norm() < kNear);
  CHECK((place_of(w, "b::end") - Vector3d(-2, 2, 6)).norm() < kNear);
}

TEST_CASE("The pose of a model is that of its placement frame") {
  SceneFile file(world("<model name='m' placement_frame='top'><pose>0 0 1 0 0 " + kQuarter + "</pose><link name='l'/>"
                       "<link name='top'><pose>1 0 2 0 0 0</pose></link></model>"
                       "<model name='n' placement_frame='in::top'><pose>5 0 0 0 0 0</pose><link name='l'/>"
                       "<model name='in'><pose>0 1 0 0 0 0</pose><link name='top'><pose>0 0 1 0 0 0</pose></link></model></model>"));
  const WorldDef w = file.load();
  CHECK((place_of(w, "m::top") - Vector3d(0, 0, 1)).norm() < kNear);
  CHECK((place_of(w, "m::l") - Vector3d(0, -1, -1)).norm() < kNear);
  CHECK((place_of(w, "n::in::top") - Vector3d(5, 0, 0)).norm() < kNear);
  CHECK((place_of(w, "n::l") - Vector3d(5, -1, -1)).norm() < kNear);
}

TEST_CASE("Joints end at frames, nested models and their canonical links, and their axes are expressed in any frame") {
  SceneFile file(world("<model name='m'><link name='a'/><link name='b'/><frame name='f' attached_to='n'/>"
                       "<frame name='turned'><pose>0 0 0 0 0 " + kQuarter + "</pose></frame>"
                       "<model name='n' canonical_link='in::z'><link name='y'/><model name='in'><link name='z'/></model></model>"
                       "<joint name='j' type='revolute'><parent>a</parent><child>f</child><axis><xyz expressed_in='turned'>1 0 0</xyz></axis></joint>"
                       "<joint name='k' type='ball'><parent>j</parent><child>b</child></joint>"
                       "<joint name='s' type='fixed'><parent>world</parent><child>__model__</child></joint></model>"));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  REQUIRE(w.joints.size() == 3);
  CHECK(w.bodies[static_cast<std::size_t>(w.joints[0].child)].name == "m::n::in::z");
  CHECK((w.joints[0].axes[0].axis - Vector3d::UnitY()).norm() < kNear);
  CHECK(w.joints[1].parent == w.joints[0].child);  // a joint moves with its child
  CHECK(w.joints[2].parent == -1);
  CHECK(w.bodies[static_cast<std::size_t>(w.joints[2].child)].name == "m::a");
}

TEST_CASE("A joint of the world connects links of two models, and a model with the world") {
  SceneFile file(world("<model name='a'><link name='l'/></model><model name='b'><pose>1 0 0 0 0 0</pose><link name='l'/></model>"
                       "<joint name='j' type='revolute'><parent>a::l</parent><child>b::l</child><axis><xyz>0 1 0</xyz></axis></joint>"
                       "<joint name='k' type='fixed'><parent>world</parent><child>a</child></joint>",
                       "1.10"));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  REQUIRE(w.joints.size() == 2);
  CHECK(w.joints[0].name == "j");
  CHECK((w.joints[0].anchor_m - Vector3d(1, 0, 0)).norm() < kNear);
  CHECK(w.joints[0].parent == 0);
  CHECK(w.joints[0].child == 1);
  CHECK(w.joints[1].parent == -1);
  CHECK(w.joints[1].child == 0);
}

TEST_CASE("Frames in a circle are rejected, and their names are given") {
  const auto circle = [](const std::string& inside) { return error_of("<model name='m'><link name='l'/>\n" + inside + "</model>"); };
  CHECK_THAT(circle("<frame name='a'><pose relative_to='a'/></frame>"), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("itself through \"a\""));
  CHECK_THAT(circle("<frame name='a'><pose relative_to='b'/></frame><frame name='b'><pose relative_to='a'/></frame>"
                    "<link name='k'><pose relative_to='b'/></link>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("\"a\"") && Catch::Contains("\"b\""));
  CHECK_THAT(circle("<frame name='a' attached_to='b'/><frame name='b' attached_to='a'><pose relative_to='l'/></frame>"
                    "<joint name='j' type='ball'><parent>l</parent><child>a</child><pose relative_to='l'/></joint>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("attached to itself"));
  CHECK_THAT(circle("<model name='n'><pose relative_to='n::k'/><link name='k'/></model>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("itself through \"n\""));
  CHECK_THAT(circle("<link name='k'><pose relative_to='j'/></link><joint name='j' type='ball'><parent>l</parent><child>k</child></joint>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("itself through"));
}

TEST_CASE("A frame that does not exist is named with the line and the scope") {
  const std::string none = "there is no such link, joint, frame or model in <model name=\"m\">";
  CHECK_THAT(error_of("<model name='m'><link name='l'>\n<pose relative_to='x'/></link></model>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("\"x\": " + none));
  CHECK_THAT(error_of("<model name='m'><link name='l'/>\n<frame name='f' attached_to='l::x'/></model>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("\"l::x\": " + none));
  CHECK_THAT(error_of("<model name='m' placement_frame='x'><link name='l'/></model>"), Catch::Contains("\"x\": " + none));
  CHECK_THAT(error_of("<model name='m'><link name='l'/><link name='k'/><joint name='j' type='revolute'><parent>l</parent><child>k</child>\n"
                      "<axis><xyz expressed_in='x'>0 0 1</xyz></axis></joint></model>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("\"x\": " + none));
  CHECK_THAT(error_of("<model name='m'><pose relative_to='l'/><link name='l'/></model>"), Catch::Contains("in <world name=\"w\">"));
  // A model sees no frames outside it.
  CHECK_THAT(error_of("<frame name='f'/><model name='m'><link name='l'><pose relative_to='f'/></link></model>"), Catch::Contains(none));
}

TEST_CASE("Names are checked: missing, reserved, with two colons, or twice") {
  CHECK_THAT(error_of("<model><link name='l'/></model>"), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("lacks its attribute \"name\""));
  CHECK_THAT(error_of("<model name='m'>\n<link/></model>"), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("lacks its attribute \"name\""));
  for (const char* name : {"world", "__model__", "____"})
    CHECK_THAT(error_of("<model name='m'><link name='" + std::string(name) + "'/></model>"), Catch::Contains("reserved"));
  CHECK_THAT(error_of("<model name='m'><link name='a::b'/></model>"), Catch::Contains("\"::\""));
  CHECK_THAT(error_of("<model name='m'><link name='a'/>\n<frame name='a'/></model>"), Catch::StartsWith("scene.sdf:4: "));
  CHECK_THAT(error_of("<model name='m'><link name='a'/></model>\n<model name='m'><link name='a'/></model>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("another <model>"));
  CHECK_THAT(error_of("<model name='m'><link name='a'><visual name='v'/>\n<visual name='v'/></link></model>"), Catch::StartsWith("scene.sdf:4: "));
}

TEST_CASE("A chain of fifty thousand frames is resolved without recursion") {
  constexpr int kFrames = 50'000;
  std::string frames;
  for (int i = kFrames; i > 0; --i)
    frames += "<frame name='f" + std::to_string(i) + "' attached_to='f" + std::to_string(i - 1) + "'><pose>0.001 0 0 0 0 0</pose></frame>\n";
  SceneFile file(world("<model name='m'><link name='a'/><link name='l'><pose relative_to='f50000'/></link>" + frames +
                       "<frame name='f0'/><joint name='j' type='fixed'><parent>l</parent><child>f50000</child></joint></model>"));
  const WorldDef w = file.load();
  // 50,000 roundings of numbers below 50.
  CHECK(place_of(w, "m::l").x() == Approx(50).epsilon(1e-9));
  CHECK(w.joints[0].child == 0);
}
