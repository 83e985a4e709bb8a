// Elements without effect never refuse a world.
#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;

namespace {

const std::string kSmallCube = "<model name='cube'><link name='l'>" + collision("<box><size>.1 .1 .1</size></box>") + "</link></model>\n";

// A world of a cube and these elements loads, with one warning for each line of it.
void check_ignored(const std::string& inside, int line = 4) {
  INFO(inside);
  SceneFile file(world(kSmallCube + inside));
  CHECK(file.load_error() == "");
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:" + std::to_string(line) + ": "));
}

}  // namespace

TEST_CASE("Unknown sensors, atmospheres, spherical coordinates and plugins are warnings, with any content") {
  check_ignored("<atmosphere type='martian'><temperature>cold</temperature></atmosphere>");
  check_ignored("<spherical_coordinates><surface_model>MOON_SCS</surface_model><latitude_deg>x</latitude_deg></spherical_coordinates>");
  check_ignored("<plugin name='p' filename='p.so'><include>none</include><model/></plugin>");
  check_ignored("<wind><linear_velocity>strong</linear_velocity></wind>");
  check_ignored("<actor name='a'><skin><filename>http://x/y.dae</filename></skin><link/></actor>");
  check_ignored("<state world_name='w'><model name='cube'><link name='l'/><link name='l'/></model></state>");
  check_ignored("<population name='p'><model_count>no</model_count><include><uri>model://none</uri></include></population>");
  check_ignored("<no_such_element with='attributes'/>");
  for (const char* sensor : {"<sensor name='s' type='air_speed'/>", "<sensor name='s' type='no_such_type'><update_rate>often</update_rate></sensor>",
                             "<sensor/>", "<sensor name='s' type='imu'><imu><noise>none</noise></imu></sensor>",
                             "<battery/>", "<particle_emitter name='e'/>", "<projector/>", "<audio_source/>"})
    check_ignored("<model name='m'><link name='k'>\n" + std::string(sensor) + "</link></model>", 5);
  check_ignored("<model name='m'><link name='k'><visual name='v'><geometry>\n<cone><radius>x</radius></cone></geometry></visual></link></model>", 5);
}

TEST_CASE("A model that a skipped include empties is a warning") {
  SceneFile file(world(kSmallCube + "<model name='robot'><include><uri>https://fuel.example/robot</uri></include></model>\n"
                               "<frame name='f' attached_to='robot'/>\n<model name='empty'/>"));
  CHECK(file.load_error() == "");
  REQUIRE(file.warnings.size() == 3);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("nothing is downloaded"));
  CHECK_THAT(file.short_warnings()[1], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("model[@name=\"robot\"] has no link"));
  CHECK_THAT(file.short_warnings()[2], Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("model[@name=\"empty\"] has no link"));
}

TEST_CASE("A missing mesh of a visual is a warning and a magenta box, with which nothing collides") {
  const auto visual = [](const std::string& name, const std::string& uri) {
    return "<visual name='" + name + "'><pose>0 0 1 0 0 0</pose><geometry>\n<mesh><uri>" + uri + "</uri></mesh></geometry></visual>";
  };
  for (const char* uri : {"none.dae", "model://none/meshes/none.dae", "https://fuel.example/x.glb", "package://p/x.stl"}) {
    INFO(uri);
    SceneFile file(link(visual("v", uri)));
    const WorldDef w = file.load();
    REQUIRE(file.warnings.size() == 1);
    CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:6: ") && Catch::Contains(uri) && Catch::Contains("magenta box"));
    REQUIRE(w.visuals.size() == 1);
    CHECK(w.visuals[0].shape.kind == ShapeKind::kBox);
    CHECK(w.visuals[0].shape.name == "v");
    CHECK(w.visuals[0].shape.pose.translation().z() == 1);
    CHECK(w.visuals[0].diffuse == Eigen::Vector3d(1, 0, 1));
    CHECK(w.shapes.empty());
  }
  SceneFile both(link(visual("v", "none.dae") + "<visual name='s'><geometry><sphere><radius>0.5</radius></sphere></geometry></visual>"));
  const WorldDef w = both.load();
  REQUIRE(w.shapes.size() == 1);
  CHECK(w.shapes[0].size_m == Eigen::Vector3d(1, 1, 1));  // the box around the sphere alone
}

TEST_CASE("A missing mesh of a collision is an error") {
  SceneFile file(link("<collision name='c'><geometry>\n<mesh><uri>none.dae</uri></mesh></geometry></collision>"));
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("not found"));
}

TEST_CASE("A joint of a link with itself is left out with a warning") {
  SceneFile file(model("<link name='a'/><frame name='f' attached_to='a'/>\n<joint name='j' type='fixed'><parent>a</parent><child>f</child></joint>"));
  CHECK(file.load().joints.empty());
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("with itself"));
}

TEST_CASE("A joint of an unknown kind that connects nothing is left out when its kind is not supported") {
  SceneFile file(model("<link name='a'/>\n<joint name='j' type='gearbox'><parent>a</parent><child>none</child></joint>"));
  CHECK(file.load_error() == "");
  CHECK(file.warnings.size() == 1);
}
