// Includes, and files that are not scenes.
#include <sstream>

#include <iostream>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/sdf/sdf_files.h"

using namespace tactus::sim;

namespace {
std::string ball(const std::string& name, const std::string& more = "") {
  return "<sdf version=\"1.6\">\n<model name=\"" + name + "\"><link name=\"l\">" +
         collision("<sphere><radius>0.1</radius></sphere>") + "</link>\n" + more + "</model>\n</sdf>\n";
}
}  // namespace

TEST_CASE("Includes are found beside the file, in its models folder, by name and through model.config") {
  SceneFile file(world("<include><uri>ball.sdf</uri><name>a</name><pose>0 0 1 0 0 0</pose></include>"
                       "<include><uri>model://deep</uri><pose>0 0 2 0 0 0</pose></include>"
                       "<include><uri>model://deep</uri><name>again</name></include>"));
  file.write("ball.sdf", ball("ball"));
  file.write("models/deep/model.config", "<model><sdf version='1.5'>old.sdf</sdf><sdf version='1.6'>new.sdf</sdf></model>");
  file.write("models/deep/new.sdf", ball("deep_ball"));
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 3);
  CHECK(w.bodies[0].name == "a::l");
  CHECK(w.bodies[0].pose.translation().z() == 1);
  CHECK(w.bodies[1].name == "deep_ball::l");
  CHECK(w.bodies[1].pose.translation().z() == 2);
  CHECK(w.bodies[2].name == "again::l");
  CHECK(file.warnings.empty());
}

TEST_CASE("Includes and meshes of an included model are searched beside that model") {
  SceneFile file(world("<include><uri>models/outer/model.sdf</uri></include>"));
  file.write("models/outer/model.sdf",
             "<sdf version='1.9'><model name='outer'><link name='l'><visual name='v'><geometry><mesh><uri>tri.obj</uri></mesh>"
             "</geometry></visual></link><include><uri>part.sdf</uri></include></model></sdf>");
  file.write("models/outer/part.sdf", ball("part"));
  file.write("models/outer/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 2);
  CHECK(w.bodies[1].name == "outer::part::l");
  CHECK(w.meshes.size() == 1);
}

TEST_CASE("A warning in an included file names that file and its line") {
  SceneFile file(world("<include><uri>ball.sdf</uri></include>"));
  file.write("ball.sdf", ball("ball", "<plugin name='p' filename='p.so'/>\n<tactus:bogus/>"));
  file.load();
  REQUIRE(file.warnings.size() == 2);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("ball.sdf:3: "));
  CHECK_THAT(file.short_warnings()[1], Catch::StartsWith("ball.sdf:4: "));
}

TEST_CASE("An include that is missing, empty, circular or invalid is rejected with its line") {
  SceneFile file(world("\n<include><uri>ball.sdf</uri></include>"));
  CHECK(file.load_error() == "scene.sdf:4: include of \"ball.sdf\" is not found: put it beside the file");
  file.write("ball.sdf", ball("ball", "<include><uri>ball.sdf</uri></include>"));
  CHECK_THAT(file.load_error(),
             Catch::StartsWith("ball.sdf:3: ") && Catch::Contains("remove the circular include"));
  file.write("ball.sdf", ball("ball", "<include><uri>scene.sdf</uri></include>"));
  CHECK_THAT(file.load_error(),
             Catch::StartsWith("ball.sdf:3: ") && Catch::Contains("remove the circular include"));
  file.write("ball.sdf", "<sdf version='1.6'><model name='m'><link name='l'></model></sdf>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("ball.sdf:1: ") && Catch::Contains("XML"));
  file.write("ball.sdf", "<sdf version='1.6'>\n<model name='m'><link name='l'/><joint name='j'\n type='revolute'/></model></sdf>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("ball.sdf:"));
  file.write("scene.sdf", world("<include><uri/></include>"));
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("lacks its <uri>"));
  file.write("scene.sdf", world("<include/>"));
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:3: "));
}

TEST_CASE("Of two files with one name, each file includes the one beside it") {
  SceneFile file(world("<include><uri>sub/outer.sdf</uri></include><include><uri>ball.sdf</uri></include>"));
  file.write("ball.sdf", ball("ball"));
  file.write("sub/ball.sdf", ball("other_ball"));
  file.write("sub/outer.sdf", "<sdf version='1.9'><model name='outer'><link name='l'/><include><uri>ball.sdf</uri></include></model></sdf>");
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 3);
  CHECK(w.bodies[1].name == "outer::other_ball::l");
  CHECK(w.bodies[2].name == "ball::l");
}

TEST_CASE("Standard Gazebo models are built in, and nothing is downloaded") {
  SceneFile file(world("<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>\n"
                       "<include><uri>https://fuel.example/box</uri></include>"));
  const WorldDef w = file.load();
  CHECK(w.lights.size() == 1);
  REQUIRE(w.bodies.size() == 1);
  CHECK(w.bodies[0].is_static);
  CHECK(w.shapes[0].kind == ShapeKind::kPlane);
  REQUIRE(file.warnings.size() == 3);
  CHECK_THAT(file.short_warnings()[2], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("nothing is downloaded"));
}

TEST_CASE("A file that is not a scene is rejected in one sentence") {
  SceneFile file;
  CHECK_THAT(file.load_error(), Catch::Contains("cannot be read"));
  file.write("scene.sdf", "");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf"));
  file.write("scene.sdf", "<sdf version='1.9'>\n<world name='w'>\n</sdf>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:2: ") || Catch::StartsWith("scene.sdf:3: "));
  file.write("scene.sdf", "<robot name='r'/>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:1: ") && Catch::Contains("<sdf version") && Catch::Contains("gz sdf -p"));
  file.write("scene.sdf", "<sdf><world name='w'/></sdf>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:1: ") && Catch::Contains("version"));
  file.write("scene.sdf", "<sdf version='99'><world name='w'/></sdf>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf"));
  for (const char* version : {"1.4", "1.9", "1.9.2", "1.10", "1.12"}) {
    file.write("scene.sdf", "<sdf version='" + std::string(version) + "'><world name='w'/></sdf>");
    CHECK(file.load_error() == "");
    CHECK(file.warnings.empty());
  }
  for (const char* version : {"1.3", "1.", "1", "2.0", "1.x", "1.-9", "1.99999999999"}) {
    INFO(version);
    file.write("scene.sdf", "<sdf version='" + std::string(version) + "'><world name='w'/></sdf>");
    CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:1: ") && Catch::Contains(version));
  }
  file.write("scene.sdf", "<sdf version='1.13'><world name='w'/></sdf>");
  CHECK(file.load_error() == "");
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], Catch::Contains("newer than 1.12"));
  file.write("scene.sdf", "<sdf version='1.9'></sdf>");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf"));
}

TEST_CASE("An invalid element is one sentence with its line, and nothing is printed") {
  std::ostringstream printed;
  std::streambuf* before = std::cerr.rdbuf(printed.rdbuf());
  SceneFile file(world("<model name='m'>\n<link name='a'/><link name='b'/>\n<joint name='j' type='revolute'><parent>a</parent>"
                       "<child>no_such_link</child><axis><xyz>0 0 1</xyz></axis></joint></model>"));
  const std::string joint = file.load_error();
  file.write("scene.sdf", link("<inertial><mass>heavy</mass></inertial>"));
  const std::string mass = file.load_error();
  file.write("scene.sdf", model("<link name='a'/>\n<link name='a'/>"));
  const std::string twice = file.load_error();
  file.write("scene.sdf", world("<model>\n</model>"));
  const std::string nameless = file.load_error();
  std::cerr.rdbuf(before);
  CHECK_THAT(joint, Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("no_such_link"));
  CHECK_THAT(mass, Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("heavy"));
  CHECK_THAT(twice, Catch::StartsWith("scene.sdf:") && Catch::Contains("a"));
  CHECK_THAT(nameless, Catch::StartsWith("scene.sdf:3: "));
  CHECK(printed.str() == "");
}

TEST_CASE("A file with only a model is a world of that model") {
  SceneFile file(ball("ball"));
  const WorldDef w = file.load();
  CHECK(w.name == "ball");
  CHECK(w.bodies.size() == 1);
}

TEST_CASE("A scene in UTF-16 or UTF-32 is refused by the name of its encoding") {
  const std::string text = world("");
  for (const int bytes : {2, 4})
    for (const bool big : {false, true})
      for (const bool mark : {false, true}) {
        std::string wide;
        const auto add = [&](unsigned character) {
          for (int i = 0; i < bytes; ++i) wide += static_cast<char>(character >> 8 * (big ? bytes - 1 - i : i) & 0xff);
        };
        if (mark) add(0xfeff);
        for (const char c : text) add(static_cast<unsigned char>(c));
        SceneFile file(wide);
        INFO(bytes << (big ? " bytes, big" : " bytes, little") << (mark ? ", mark" : ""));
        CHECK(file.load_error() == "scene.sdf:1: this is UTF-" + std::to_string(8 * bytes) + " and not UTF-8: save it as UTF-8");
      }
}

TEST_CASE("Entities of a scene are not replaced, which a warning with the line says") {
  SceneFile file("<?xml version=\"1.0\"?>\n<!DOCTYPE sdf [<!ENTITY a SYSTEM \"file:///etc/passwd\">]>\n<sdf version=\"1.9\"><world name=\"w\">&a;</world></sdf>");
  file.load();
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.short_warnings()[0] == "scene.sdf:2: <!DOCTYPE> has no effect: its entities are not replaced, write them out");
}
