// Elements of older versions of SDFormat.
#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {

constexpr double kClose = 1e-12;

// The axis of a joint whose frame is turned by a quarter about z.
Vector3d axis_of(const std::string& version, const std::string& inside, const std::string& attributes = "") {
  SceneFile file(world("<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent><child>b</child>"
                       "<pose>0 0 0 0 0 1.5707963267948966</pose><axis><xyz" + attributes + ">1 0 0</xyz>" + inside + "</axis></joint></model>",
                       version));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  REQUIRE(w.joints.size() == 1);
  return w.joints[0].axes[0].axis;
}

}  // namespace

TEST_CASE("An axis is in the frame of the model in 1.4, and where use_parent_model_frame says so until 1.6") {
  const std::string of_model = "<use_parent_model_frame>true</use_parent_model_frame>", own = "<use_parent_model_frame>0</use_parent_model_frame>";
  CHECK((axis_of("1.4", "") - Vector3d::UnitX()).norm() < kClose);
  for (const char* version : {"1.5", "1.6"}) {
    CHECK((axis_of(version, "") - Vector3d::UnitY()).norm() < kClose);
    CHECK((axis_of(version, own) - Vector3d::UnitY()).norm() < kClose);
    CHECK((axis_of(version, of_model) - Vector3d::UnitX()).norm() < kClose);
  }
  for (const char* version : {"1.7", "1.9", "1.12"}) {
    CHECK((axis_of(version, "") - Vector3d::UnitY()).norm() < kClose);
    CHECK((axis_of(version, "", " expressed_in='__model__'") - Vector3d::UnitX()).norm() < kClose);
  }
}

TEST_CASE("Gravity is inside physics until 1.5") {
  SceneFile file(world("<physics type='ode'><gravity>0 0 -1.6</gravity></physics>", "1.5"));
  CHECK(file.load().gravity_m_s2.z() == -1.6);
  CHECK(file.warnings.empty());
  file.write("scene.sdf", world("<physics type='ode'><gravity>0 0 -1.6</gravity></physics>", "1.6"));
  CHECK(file.load().gravity_m_s2.z() == -9.8);
  CHECK(file.warnings.size() == 1);
}

TEST_CASE("A pose names its frame by frame until 1.6, and a name may be that of a link and a joint") {
  SceneFile file(world("<model name='m'><link name='a'><pose>1 0 0 0 0 0</pose></link><link name='b'><pose frame='a'>0 1 0 0 0 0</pose></link>\n"
                       "<joint name='b' type='ball'><parent>a</parent><child>b</child></joint></model>",
                       "1.6"));
  const WorldDef w = file.load();
  CHECK((w.bodies[1].pose.translation() - Vector3d(1, 1, 0)).norm() < kClose);
  REQUIRE(w.joints.size() == 1);
  CHECK(w.joints[0].name == "m::b_joint");
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("b_joint"));
}

TEST_CASE("Names with two colons are names until 1.7") {
  SceneFile file(world("<model name='m'><link name='n::a'><pose>1 0 0 0 0 0</pose></link><frame name='n::f' attached_to='n::a'/>"
                       "<link name='b'><pose relative_to='n::f'>0 1 0 0 0 0</pose></link>"
                       "<joint name='n::j' type='fixed'><parent>n::f</parent><child>b</child></joint></model>",
                       "1.7"));
  const WorldDef w = file.load();
  CHECK((w.bodies[1].pose.translation() - Vector3d(1, 1, 0)).norm() < kClose);
  CHECK(w.joints.size() == 1);
}

TEST_CASE("An automatic inertia comes from the density of the collision, the link or water") {
  const auto body = [](const std::string& of_inertial, const std::string& of_first) {
    SceneFile file(world("<model name='m'><link name='l'><inertial auto='true'>" + of_inertial + "</inertial>"
                         "<collision name='a'><pose>-1 0 0 0 0 0</pose>" + of_first + "<geometry><box><size>1 1 1</size></box></geometry></collision>"
                         "<collision name='b'><pose>1 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>",
                         "1.11"));
    BodyDef b = file.load().bodies[0];
    CHECK(file.warnings.empty());
    return b;
  };
  // Two cubes of mass m at -1 and 1: about x m/6 each, about z m/6 + m each.
  const BodyDef water = body("", "");
  CHECK(water.mass_kg == Approx(2000));
  CHECK(water.centre_of_mass_m.norm() < 1e-12);
  CHECK(water.inertia_kg_m2(0, 0) == Approx(2000.0 / 6));
  CHECK(water.inertia_kg_m2(2, 2) == Approx(2000.0 / 6 + 2000));
  CHECK(body("<density>10</density>", "").mass_kg == Approx(20));
  const BodyDef both = body("<density>10</density>", "<density>30</density>");
  CHECK(both.mass_kg == Approx(40));
  CHECK(both.centre_of_mass_m.x() == Approx(-0.5));
  CHECK(both.inertia_kg_m2(2, 2) == Approx(40.0 / 6 + 30 * 0.25 + 10 * 2.25));
  const BodyDef scaled = body("<mass>4</mass>", "");
  CHECK(scaled.mass_kg == Approx(4));
  CHECK(scaled.inertia_kg_m2(2, 2) == Approx(4.0 / 6 + 4));
  SceneFile bad(world("<model name='m'><link name='l'><inertial auto='true'>\n<density>-1</density></inertial>" +
                      collision("<box><size>1 1 1</size></box>") + "</link></model>"));
  CHECK_THAT(bad.load_error(), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("density"));
}

TEST_CASE("Flags in attributes have any case of letters, and another word is refused with its line") {
  const auto scene = [](const std::string& automatic, const std::string& merged, const std::string& degrees) {
    SceneFile file(world("<model name='m'>\n<link name='l'><inertial auto='" + automatic + "'/>" + collision("<box><size>1 1 1</size></box>") +
                         "</link>\n<include merge='" + merged + "'><uri>tower.sdf</uri></include>\n<link name='k'><pose degrees='" + degrees + "'>0 0 0 0 0 180</pose></link></model>"));
    file.write("tower.sdf", "<sdf version='1.9'><model name='t'><link name='base'/></model></sdf>");
    return std::pair(file.load_error(), file.load_error().empty() ? file.load() : WorldDef{});
  };
  for (const char* yes : {"true", "True", "TRUE", "1", " true "}) {
    INFO(yes);
    const auto [error, w] = scene(yes, yes, yes);
    REQUIRE(error.empty());
    CHECK(w.bodies[0].mass_kg == Approx(1000));  // of water, not SDF's 1 kg
    CHECK(w.bodies[1].name == "m::base");
    CHECK(w.bodies[2].pose.linear()(0, 0) == Approx(-1));
  }
  REQUIRE(scene("False", "1", "FALSE").second.bodies.size() == 3);
  CHECK(scene("False", "1", "FALSE").second.bodies[0].mass_kg == Approx(1));
  CHECK_THAT(scene("yes", "1", "1").first, Catch::Contains("scene.sdf:4: ") && Catch::Contains("has auto=\"yes\": it must be true or false"));
  CHECK_THAT(scene("1", "maybe", "1").first, Catch::Contains("scene.sdf:5: ") && Catch::Contains("has merge=\"maybe\": it must be true or false"));
  CHECK_THAT(scene("1", "1", "on").first, Catch::Contains("scene.sdf:6: ") && Catch::Contains("has degrees=\"on\": it must be true or false"));
}

TEST_CASE("A density without an automatic inertia is a warning") {
  SceneFile file(world("<model name='m'><link name='l'><inertial>\n<density>10</density></inertial></link></model>"));
  file.load();
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("density"));
}
