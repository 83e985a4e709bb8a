// The <tactus:...> elements: materials, tools, settings.
#include <tactus/material_def_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/materials/materials.h"
#include "sync/degradation/profile.h"

using namespace tactus;
using namespace tactus::sim;

namespace {
std::string load_error(const std::string& inside) {
  SceneFile file(world(inside));
  return file.load_error();
}
WorldDef load(const std::string& inside) {
  SceneFile file(world(inside));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  return w;
}
const material_def_t& material(const WorldDef& w, const std::string& name) {
  for (const auto& m : w.materials)
    if (m.name == name) return m;
  FAIL("no material " + name);
  return w.materials.front();
}
}  // namespace

TEST_CASE("The table of materials is complete and in range, and every value has a source") {
  const auto materials = builtin_materials();
  CHECK(materials.size() >= 12);
  for (const char* name : {"steel", "aluminium", "copper", "glass", "granite", "ceramic", "oak", "abs", "rubber", "foam", "skin",
                           "concrete", "felt"}) {
    INFO(name);
    CHECK(std::count_if(materials.begin(), materials.end(), [&](const auto& m) { return m.name == name; }) == 1);
  }
  for (const auto& m : materials) CHECK(m.friction_static >= m.friction_dynamic);
}

TEST_CASE("An invalid row of the table of materials is rejected with its number") {
  const std::string header =
      "name,youngs_modulus_Pa,poissons_ratio,density_kg_m3,rayleigh_alpha_1_s,rayleigh_beta_s,friction_static,friction_dynamic,"
      "restitution,conductivity_W_mK,specific_heat_J_kgK,temperature_degC,any_source\n";
  CHECK(parse_materials(header + "a,1e9,0.3,1000,1,1e-6,0.5,0.4,0.5,1,1000,23,\"one, two\"\n").size() == 1);
  CHECK_THROWS_WITH(parse_materials(header + "a,1e9,0.3,1000,1,1e-6,0.5,0.4,0.5,1,1000,23,\n"), Catch::Contains("materials.csv:2"));
  CHECK_THROWS_WITH(parse_materials(header + "a,1e9,0.7,1000,1,1e-6,0.5,0.4,0.5,1,1000,23,x\n"), Catch::Contains("poissons_ratio"));
  CHECK_THROWS_WITH(parse_materials(header + "a,1e9\n"), Catch::Contains("cells"));
}

TEST_CASE("A scene can change, derive and define materials") {
  const WorldDef w = load("<tactus:material name='steel' temperature='45degC'/>"
                          "<tactus:material name='warm_oak' base='oak' temperature='40' density='900kg/m3'/>"
                          "<tactus:material name='new' youngs_modulus='3GPa' poissons_ratio='0.3' density='1200' rayleigh_alpha='1'"
                          " rayleigh_beta='1us' friction_static='0.5' friction_dynamic='0.4' restitution='0.5' conductivity='1'"
                          " specific_heat='900' temperature='23'/>");
  CHECK(material(w, "steel").temperature_degC == 45);
  CHECK(material(w, "steel").density_kg_m3 == 7850);
  CHECK(material(w, "warm_oak").density_kg_m3 == 900);
  CHECK(material(w, "warm_oak").conductivity_W_mK == material(w, "oak").conductivity_W_mK);
  CHECK(material(w, "oak").temperature_degC == 23);
  CHECK(material(w, "new").youngs_modulus_Pa == Approx(3e9));
  CHECK(material(w, "new").rayleigh_beta_s == Approx(1e-6));
}

TEST_CASE("An invalid material is rejected with its line") {
  CHECK_THAT(load_error("\n<tactus:material name='x' density='1200'/>"), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("lacks"));
  CHECK_THAT(load_error("<tactus:material name='x' base='y'/>"), Catch::Contains("no such material"));
  CHECK_THAT(load_error("<tactus:material density='1'/>"), Catch::Contains("\"name\""));
  CHECK_THAT(load_error("<tactus:material name='steel' density='-1'/>"), Catch::Contains("between 1 and 25000"));
  CHECK_THAT(load_error("<tactus:material name='steel' density='7 km'/>"), Catch::Contains("not a unit"));
  CHECK_THAT(load_error("<tactus:material name='steel' densty='7'/>"), Catch::Contains("no attribute \"densty\""));
  CHECK_THAT(load_error("<model name='m'>\n<tactus:surface material='stel'/><link name='l'/></model>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("\"stel\"") && Catch::Contains("steel"));
}

TEST_CASE("A tool is the last body and starts at the first point of its path") {
  SceneFile file(world(
      "<tactus:tool name='hand' radius='8mm' mass='120g' material='skin' device='playback:x.csv,rate=2' "
      "loop='true'>"
      "<tactus:waypoint time='0s' position='1 2 3'/><tactus:waypoint time='500ms' position='1 2 2'/></tactus:tool>"
      "<model name='m'><link name='l'/></model>"));
  file.write("x.csv", "time_s,x_m,y_m,z_m\n");
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 2);
  REQUIRE(w.tools.size() == 1);
  const tool_def_t& t = w.tools[0];
  CHECK(w.bodies[1].tool == 0);
  CHECK(w.bodies[0].tool == -1);
  CHECK(t.body == 1);
  CHECK(w.bodies[1].pose.translation() == Eigen::Vector3d(1, 2, 3));
  CHECK(t.radius_m == Approx(0.008));
  CHECK(t.mass_kg == Approx(0.12));
  CHECK(w.materials[static_cast<std::size_t>(t.material)].name == "skin");
  CHECK(t.device == "playback:" + (file.folder() / "x.csv").string() + ",rate=2");
  CHECK(t.loop == 1);
  REQUIRE(t.waypoint_count == 2);
  CHECK(t.waypoints[1].time_s == 0.5);
  CHECK(t.waypoints[1].position_m.z == 2);
}

TEST_CASE("A hole names the ball that fills it by body or model") {
  const std::string ball = "<model name='ball'><link name='l'/></model><model name='two'><link name='a'/><link name='b'/></model>"
                           "<model name='rock'><static>true</static><link name='l'/></model>";
  const WorldDef w = SceneFile(world(ball + "<tactus:hole name='h' position='1 2 3' radius='30mm' depth='10cm' ball='ball'/>"
                                            "<tactus:hole name='i' position='0 0 0' radius='0.1m' ball='two::b'/>"))
                         .load();
  REQUIRE(w.holes.size() == 2);
  CHECK(w.bodies[static_cast<std::size_t>(w.holes[0].ball)].name == "ball::l");
  CHECK(w.bodies[static_cast<std::size_t>(w.holes[1].ball)].name == "two::b");
  CHECK(w.holes[0].position_m == Eigen::Vector3d(1, 2, 3));
  CHECK(w.holes[0].radius_m == Approx(0.03));
  CHECK(w.holes[0].depth_m == Approx(0.1));
  CHECK_THAT(load_error(ball + "<tactus:hole name='h' position='0 0 0' radius='1cm' ball='two'/>"), Catch::Contains("no such body"));
  CHECK_THAT(load_error(ball + "<tactus:hole name='h' position='0 0 0' radius='1cm' ball='rock'/>"), Catch::Contains("cannot fall"));
  CHECK_THAT(load_error(ball + "<tactus:hole name='h' position='0 0 0' ball='ball'/>"), Catch::Contains("\"radius\""));
  CHECK_THAT(load_error(ball + "<tactus:hole name='h' position='0 0' radius='1cm' ball='ball'/>"), Catch::Contains("3 finite"));
  CHECK_THAT(load_error(ball + "<tactus:hole name='h' position='0 0 0' radius='0m' ball='ball'/>"), Catch::Contains("between"));
}

TEST_CASE("A tool may have a shape, and has the inertia of a solid of that shape") {
  const std::string point = "<tactus:waypoint time='1' position='0 0 0'/></tactus:tool>";
  const auto tool = [&](const std::string& attributes, const auto& check) {
    const WorldDef w = SceneFile(world("<tactus:tool name='h' mass='0.2kg' " + attributes + ">" + point)).load();
    REQUIRE(w.tools.size() == 1);
    check(w.tools[0], w.bodies.back());
  };
  tool("shape='box' size='4cm 6cm 20mm'", [](const tool_def_t& t, const BodyDef& b) {
    CHECK(t.shape == tool_def_t::BOX);
    CHECK(t.size_m.y == Approx(0.06));
    CHECK(t.radius_m == Approx(0.5 * std::sqrt(0.04 * 0.04 + 0.06 * 0.06 + 0.02 * 0.02)));
    CHECK(b.inertia_kg_m2(2, 2) == Approx(0.2 / 12 * (0.04 * 0.04 + 0.06 * 0.06)));
  });
  tool("shape='capsule' radius='5mm' length='8cm'", [](const tool_def_t& t, const BodyDef& b) {
    CHECK(t.shape == tool_def_t::CAPSULE);
    CHECK(t.size_m.x == Approx(0.005));
    CHECK(t.size_m.z == Approx(0.08));
    CHECK(t.radius_m == Approx(0.045));
    CHECK(b.inertia_kg_m2(0, 0) > 10 * b.inertia_kg_m2(2, 2));
  });
  tool("radius='5mm'", [](const tool_def_t& t, const BodyDef& b) {
    CHECK(t.shape == tool_def_t::BALL);
    CHECK(b.inertia_kg_m2(0, 0) == Approx(0.4 * 0.2 * 0.005 * 0.005));
  });
  const auto said = [&](const std::string& attributes) {
    return load_error("<tactus:tool name='h' " + attributes + ">" + point);
  };
  CHECK_THAT(said("shape='cone' size='1cm 1cm 1cm'"), Catch::Contains("\"cone\""));
  CHECK_THAT(said("shape='box'"), Catch::Contains("\"size\""));
  CHECK_THAT(said("shape='box' size='4cm 6cm'"), Catch::Contains("size"));
  CHECK_THAT(said("shape='box' size='4cm 6cm 0m'"), Catch::Contains("size"));
  CHECK_THAT(said("shape='capsule' radius='1cm'"), Catch::Contains("\"length\""));
  CHECK_THAT(said("shape='mesh'"), Catch::Contains("\"mesh\""));
  CHECK_THAT(said("shape='mesh' mesh='nowhere.obj'"), Catch::Contains("nowhere.obj"));
  CHECK_THAT(said("shape='box' size='90cm 90cm 2m'"), Catch::Contains("size"));
}

TEST_CASE("An invalid tool is rejected with its line") {
  const std::string point = "<tactus:waypoint time='1' position='0 0 0'/>";
  CHECK_THAT(load_error("<tactus:tool name='h'/>"), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("waypoint"));
  CHECK_THAT(load_error("<tactus:tool name='h'>\n" + point + "\n" + point + "</tactus:tool>"),
             Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("times must increase"));
  CHECK_THAT(load_error("<tactus:tool name='h'><tactus:waypoint time='1' position='0 0'/></tactus:tool>"), Catch::Contains("3 finite"));
  CHECK_THAT(load_error("<tactus:tool name='h'><tactus:waypoint time='1'/></tactus:tool>"), Catch::Contains("position"));
  CHECK_THAT(load_error("<tactus:tool name='h' radius='2m'>" + point + "</tactus:tool>"), Catch::Contains("radius"));
  CHECK_THAT(load_error("<tactus:tool name='h' loop='maybe'>" + point + "</tactus:tool>"), Catch::Contains("true or false"));
  CHECK_THAT(load_error("<tactus:tool name='h' material='air'>" + point + "</tactus:tool>"), Catch::Contains("\"air\""));
  CHECK_THAT(load_error("<tactus:tool>" + point + "</tactus:tool>"), Catch::Contains("\"name\""));
}

TEST_CASE("An invalid device is rejected with its line before a node starts") {
  const auto said = [](const std::string& device) {
    SceneFile file(world("\n<tactus:tool name='h' device='" + device +
                         "'><tactus:waypoint time='1' position='0 0 0'/></tactus:tool>"));
    file.write("short.csv", "time_s,x_m,y_m,z_m\n");
    file.write("long.csv", "");
    std::filesystem::resize_file(file.folder() / "long.csv", (64 << 20) + 1);
    std::filesystem::create_directory(file.folder() / "folder");
    return file.load_error();
  };
  CHECK(said("playback:short.csv") == "");
  CHECK(said("virtual_hand:short.csv") == "");
  CHECK(said("spidar:cave,offset=0/0/1") == "");
  CHECK(said("external:arm") == "");
  for (const char* device :
       {"evil", "", "playback", "playback:short.csv,rate=0", "playback:short.csv,colour=red", "spidar",
        "external:"}) {
    INFO(device);
    CHECK_THAT(said(device), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("device"));
  }
  for (const char* device :
       {"playback:none.csv", "playback:/dev/zero", "virtual_hand:folder", "playback:long.csv", "spidar:none.json"}) {
    INFO(device);
    CHECK_THAT(said(device), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("names \""));
  }
  CHECK_THAT(said("playback:long.csv"), Catch::Contains("64 MiB"));
}

TEST_CASE("Node settings are validated and passed on as written") {
  const WorldDef w = load("<tactus:audio_node presentation_delay='25ms' device='virtual'/>");
  REQUIRE(w.settings.size() == 2);
  CHECK(w.settings[0].node == "audio_node");
  CHECK(w.settings[0].name == "presentation_delay");
  CHECK(w.settings[0].value == "25ms");
}

TEST_CASE("A setting that is unknown or out of range is rejected with its line") {
  CHECK_THAT(load_error("\n<tactus:audio_node presentation_dely='25ms'/>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("no setting \"presentation_dely\""));
  CHECK_THAT(load_error("<tactus:audio_node presentation_delay='25'/>"),
             Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("between"));
  CHECK_THAT(load_error("<tactus:audio_node presentation_delay='25kg'/>"), Catch::Contains("not a unit"));
  CHECK_THAT(load_error("<tactus:haptic_node force_limit='30 N'/>"), Catch::StartsWith("scene.sdf:3: ") &&
                                                                      Catch::Contains("only tighten") &&
                                                                      Catch::Contains("8 N or less"));
  CHECK(load_error("<tactus:haptic_node force_limit='3 N'/>").empty());
}

TEST_CASE("Settings of an unknown node are passed on with a warning") {
  SceneFile file(world("\n<tactus:smell_node strength='3'/>"));
  const WorldDef w = file.load();
  REQUIRE(w.settings.size() == 1);
  CHECK(w.settings[0].node == "smell_node");
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:4: /sdf/world[@name=\"w\"]/tactus:smell_node "));
}

TEST_CASE("A degradation profile in a scene is read, and an invalid one is rejected with its line") {
  const WorldDef w = load("<tactus:profile name='late &amp; sparse' seed='7'>\n"
                          "<tactus:degrade modality='audio' delay='40ms' jitter='3ms normal'/>\n"
                          "<tactus:degrade modality='visual' rate='5Hz'/></tactus:profile>");
  const sync::Profile profile = sync::parse_profile(w.profile, "scene");
  CHECK(profile.name == "late & sparse");
  CHECK(profile.seed == 7);
  REQUIRE(profile.rules.size() == 2);
  CHECK(profile.rules[0].delay->delay_s == Approx(0.04));
  CHECK(profile.rules[1].modality == "visual");
  CHECK(load("").profile.empty());

  const auto at = [](const std::string& rule) { return load_error("<tactus:profile>\n" + rule + "\n</tactus:profile>"); };
  CHECK_THAT(at("<tactus:degrade modality='audio' delay='40kg'/>"), Catch::Contains("delay=\"40kg\""));
  CHECK_THAT(at("<tactus:degrade delay='40ms'/>"), Catch::Contains("needs a modality"));
  CHECK_THAT(at("<tactus:worsen modality='audio'/>"), Catch::Contains("tactus:degrade"));
  CHECK_THAT(load_error("<tactus:profile colour='red'/>"), Catch::Contains("colour"));
  CHECK_THAT(load_error("<tactus:profile/><tactus:profile/>"), Catch::Contains("second profile"));
  CHECK_THAT(load_error("<tactus:profile file='none.xml'/>"), Catch::Contains("none.xml"));
}

TEST_CASE("A scene can name the file of its profile") {
  SceneFile file(world("<tactus:profile file='late.xml'/>"));
  file.write("late.xml", "<profile name='late'><degrade modality='audio' delay='40ms'/></profile>");
  CHECK(sync::parse_profile(file.load().profile, "late.xml").name == "late");
  file.write("late.xml", "<profile><degrade/></profile>");
  CHECK_THAT(file.load_error(), Catch::Contains("late.xml:1"));
}

TEST_CASE("A profile in a scene with an unknown modality causes a warning with the line") {
  SceneFile file(world("\n<tactus:profile>\n<tactus:degrade modality='smell' delay='1ms'/>\n</tactus:profile>"));
  CHECK_FALSE(file.load().profile.empty());
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:5: ") &&
                                           Catch::Contains("there is no modality \"smell\"") &&
                                           Catch::Contains("another program may have it"));
}

TEST_CASE("A profile in a scene that names an unknown material or body is rejected with the line") {
  const std::string ball =
      "<model name='ball'><link name='l'/></model><model name='floor'><link name='l'/></model>";
  const auto at = [&](const std::string& what) {
    return load_error(ball + "\n<tactus:profile>\n<tactus:degrade modality='audio' off='true' " + what +
                   "/></tactus:profile>");
  };
  CHECK(at("material='steel' bodies='floor::l ball::l'").empty());
  CHECK_THAT(at("material='stele'"), Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("no such material"));
  CHECK_THAT(at("bodies='ball::l flor::l'"),
             Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("no body \"flor::l\""));
  CHECK_THAT(at("bodies='ball floor::l'"),
             Catch::Contains("no body \"ball\"") && Catch::Contains("is \"ball::l\" meant?"));

  SceneFile file(world(ball + "<tactus:profile file='late.xml'/>"));
  file.write("late.xml", "<profile>\n<degrade modality='audio' material='stele' off='true'/></profile>");
  CHECK_THAT(file.load_error(), Catch::Contains("late.xml:2: material=\"stele\""));
  file.write("late.xml", "<profile>\n\n<degrade modality='smell' delay='1ms'/></profile>");
  CHECK_FALSE(file.load().profile.empty());
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], Catch::Contains("late.xml:3: there is no modality \"smell\""));
}

TEST_CASE("Text or elements inside <tactus:degrade> and text in its profile are rejected") {
  CHECK_THAT(load_error("<tactus:profile>\ndegrade modality='audio' off='true'</tactus:profile>"),
             Catch::Contains("has text in it"));
  CHECK_THAT(
      load_error(
          "<tactus:profile><tactus:degrade modality='audio' off='true'>loss</tactus:degrade></tactus:profile>"),
      Catch::Contains("has text in it"));
  CHECK_THAT(load_error("<tactus:profile><tactus:degrade modality='audio' "
                        "off='true'><tactus:x/></tactus:degrade></tactus:profile>"),
             Catch::Contains("has only attributes"));
}

TEST_CASE("A map can drive only a live number, within its range and safety limit") {
  const WorldDef w = load("<tactus:map from='haptic_node.force' to='visual_node.exposure' gain='2' offset='1' high='5'/>"
                          "<tactus:map from='sim_node.world.time' to='haptic_node_left.force_limit' low='500mN'/>");
  REQUIRE(w.maps.size() == 2);
  CHECK(w.maps[0].tag == "haptic_node.force");
  CHECK(w.maps[0].setting == "visual_node.exposure");
  CHECK(w.maps[0].gain == 2);
  CHECK(w.maps[0].offset == 1);
  CHECK(w.maps[0].low == 0.01);
  CHECK(w.maps[0].high == 5);
  CHECK(w.maps[1].gain == 1);
  CHECK(w.maps[1].low == 0.5);
  CHECK(w.maps[1].high == 8);  // its default: no scene may loosen it
  const auto map = [](const std::string& rest) { return load_error("<tactus:map " + rest + "/>"); };
  CHECK_THAT(map("from='force' to='visual_node.exposure'"), Catch::Contains("NODE.NAME"));
  CHECK_THAT(map("from='a.b'"), Catch::Contains("to"));
  CHECK_THAT(map("from='a.b' to='nose_node.exposure'"), Catch::Contains("no such node"));
  CHECK_THAT(map("from='a.b' to='visual_node.width'"), Catch::Contains("exposure"));  // a possible setting
  CHECK_THAT(map("from='a.b' to='visual_node.overlay'"), Catch::Contains("not a number"));
  CHECK_THAT(map("from='a.b' to='haptic_node.force_limit' high='20N'"), Catch::Contains("high"));
  CHECK_THAT(map("from='a.b' to='visual_node.exposure' low='3' high='2'"), Catch::Contains("low"));
  CHECK_THAT(map("from='a.b' to='visual_node.exposure' gian='3'"), Catch::Contains("gian"));
}
