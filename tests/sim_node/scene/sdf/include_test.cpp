// Includes: overrides, merged models, placement frames, lights, and files in other formats.
#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {

constexpr double kNearby = 1e-12;

// A file with a model of two links and a joint, `top` 1 m above `base`.
std::string tower(const std::string& attributes = "", const std::string& more = "") {
  return "<sdf version='1.9'><model name='tower' " + attributes + "><pose>9 9 9 0 0 0</pose><static>true</static>" + more +
         "<link name='base'/><link name='top'><pose>0 0 1 0 0 0</pose></link>"
         "<joint name='j' type='revolute'><parent>base</parent><child>top</child><axis><xyz expressed_in='__model__'>1 0 0</xyz></axis></joint>"
         "</model></sdf>";
}

Vector3d position(const WorldDef& w, const std::string& name) {
  for (const BodyDef& body : w.bodies)
    if (body.name == name) return body.pose.translation();
  FAIL("no body " << name);
  return {};
}

WorldDef load_with(const std::string& inside, const std::string& included = tower()) {
  SceneFile file(world(inside));
  file.write("tower.sdf", included);
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  return w;
}

std::string error_with(const std::string& inside, const std::string& included = tower()) {
  SceneFile file(world(inside));
  file.write("tower.sdf", included);
  return file.load_error();
}

}  // namespace

TEST_CASE("An include changes name, pose and static, and the pose may be relative to a frame") {
  const WorldDef w = load_with("<frame name='f'><pose>1 0 0 0 0 0</pose></frame><include><uri>tower.sdf</uri></include>"
                               "<include><uri>tower.sdf</uri><name>b</name><static>false</static><pose relative_to='f'>0 1 0 0 0 0</pose></include>"
                               "<include><uri>tower.sdf</uri><name>c</name><pose/></include>");
  CHECK((position(w, "tower::top") - Vector3d(9, 9, 10)).norm() < kNearby);
  CHECK((position(w, "b::top") - Vector3d(1, 1, 1)).norm() < kNearby);
  CHECK((position(w, "c::top") - Vector3d(0, 0, 1)).norm() < kNearby);
  CHECK(w.bodies[0].is_static);
  CHECK_FALSE(w.bodies[2].is_static);
  REQUIRE(w.joints.size() == 1);  // static links have none
  CHECK(w.joints[0].name == "b::j");
}

TEST_CASE("An include places a model by a frame of it") {
  const WorldDef w = load_with("<include><uri>tower.sdf</uri><placement_frame>top</placement_frame><pose>0 0 5 0 0 0</pose></include>");
  CHECK((position(w, "tower::top") - Vector3d(0, 0, 5)).norm() < kNearby);
  CHECK((position(w, "tower::base") - Vector3d(0, 0, 4)).norm() < kNearby);
  CHECK_THAT(error_with("<include><uri>tower.sdf</uri><placement_frame>top</placement_frame></include>"),
             Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("without <pose>"));
}

TEST_CASE("A merged model gives its links, joints and frames to the model around it") {
  const std::string quarter = "1.5707963267948966";
  const WorldDef w = load_with("<model name='m'><pose>1 0 0 0 0 0</pose><link name='own'/>"
                               "<include merge='true'><uri>tower.sdf</uri><pose relative_to='own'>0 0 2 0 0 " + quarter + "</pose></include>"
                               "<joint name='k' type='fixed'><parent>own</parent><child>base</child></joint></model>");
  REQUIRE(w.bodies.size() == 3);
  CHECK_FALSE(w.bodies[1].is_static);  // only the outer model decides
  CHECK((position(w, "m::base") - Vector3d(1, 0, 2)).norm() < kNearby);
  CHECK((position(w, "m::top") - Vector3d(1, 0, 3)).norm() < kNearby);
  REQUIRE(w.joints.size() == 2);
  CHECK(w.joints[0].name == "m::j");
  CHECK((w.joints[0].axes[0].axis - Vector3d::UnitY()).norm() < kNearby);  // in the frame of the merged model
  const WorldDef placed = load_with("<model name='m'><link name='own'/><include merge='1'><uri>tower.sdf</uri><placement_frame>top</placement_frame>"
                                    "<pose>0 0 5 0 0 " + quarter + "</pose></include></model>");
  CHECK((position(placed, "m::top") - Vector3d(0, 0, 5)).norm() < kNearby);
  CHECK((position(placed, "m::base") - Vector3d(0, 0, 4)).norm() < kNearby);
}

TEST_CASE("A merged world gives its models to the world around it") {
  SceneFile file(world("<include merge='true'><uri>room.sdf</uri></include>"));
  file.write("room.sdf", world("<model name='table'><link name='l'/></model><include><uri>tower.sdf</uri></include>"));
  file.write("tower.sdf", tower());
  CHECK(file.load().bodies.size() == 3);
}

TEST_CASE("A light is included, and a file that includes another is itself included") {
  SceneFile file(world("<include><uri>lamp.sdf</uri><name>a</name></include><include><uri>outer.sdf</uri><name>b</name><pose>1 0 0 0 0 0</pose></include>"));
  file.write("lamp.sdf", "<sdf version='1.6'><light name='lamp' type='point'><intensity>2</intensity></light></sdf>");
  file.write("outer.sdf", "<sdf version='1.9'><include><uri>tower.sdf</uri><name>c</name></include></sdf>");
  file.write("tower.sdf", tower());
  const WorldDef w = file.load();
  REQUIRE(w.lights.size() == 1);
  CHECK(w.lights[0].name == "a");
  CHECK(w.lights[0].intensity == 2);
  CHECK((position(w, "b::top") - Vector3d(1, 0, 1)).norm() < kNearby);
}

TEST_CASE("Children of an include that have no effect are warnings") {
  SceneFile file(world("<include><uri>tower.sdf</uri>\n<plugin name='p' filename='p.so'/>\n<gravity>false</gravity></include>"));
  file.write("tower.sdf", tower());
  file.load();
  REQUIRE(file.warnings.size() == 2);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:5: "));
  CHECK_THAT(file.short_warnings()[1], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("model[@name=\"tower\"]/plugin"));
}

TEST_CASE("A file that cannot be included is rejected with the line of the include") {
  CHECK_THAT(error_with("\n<include><uri>tower.sdf</uri></include>", "<robot name='r'/>"),
             Catch::StartsWith("tower.sdf:1: ") && Catch::Contains("URDF") && Catch::Contains("gz sdf -p") && Catch::Contains("scene.sdf:4"));
  CHECK_THAT(error_with("\n<include><uri>tower.sdf</uri></include>", "<sdf version='1.9'/>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("no <model>"));
  CHECK_THAT(error_with("<include><uri>tower.sdf</uri></include>",
                        "<sdf version='1.9'><model name='m'><pose relative_to='x'/><link name='l'/></model></sdf>"),
             Catch::StartsWith("tower.sdf:1: ") && Catch::Contains("outermost"));
  CHECK_THAT(error_with("<include><uri>tower.sdf</uri></include>\n<include><uri>tower.sdf</uri></include>"), Catch::Contains("another <model>"));
}

TEST_CASE("Thirty thousand includes of one model are read in a few files") {
  // Linear: no sleep and no clock here; a quadratic search would take minutes.
  std::string includes;
  for (int i = 0; i < 30'000; ++i) includes += "<include><uri>dot.sdf</uri><name>m" + std::to_string(i) + "</name></include>\n";
  SceneFile file(world(includes));
  file.write("dot.sdf", "<sdf version='1.9'><model name='dot'><static>true</static><link name='l'/></model></sdf>");
  CHECK(file.load().bodies.size() == 30'000);
}
