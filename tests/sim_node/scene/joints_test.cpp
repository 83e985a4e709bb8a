#include "sim_node/scene/joints.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
// Two links, the second 1 m beside the first, and a joint; `inside` begins on line 6.
std::string jointed(const std::string& type, const std::string& inside) {
  return model("<pose>0 0 2 0 0 1.5707963267948966</pose>\n<link name='a'/><link name='b'><pose>1 0 0 0 0 0</pose></link><joint "
               "name='j' type='" + type + "'><parent>a</parent><child>b</child>\n" + inside + "</joint>");
}
const std::string kAxis = "<axis><xyz>1 0 0</xyz></axis>";
JointDef joint(const std::string& text) {
  SceneFile file(text);
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  REQUIRE(w.joints.size() == 1);
  return w.joints.front();
}
}  // namespace

TEST_CASE("A revolute joint has anchor and axis in the world, limits, damping, friction and spring") {
  const JointDef j = joint(jointed("revolute", "<axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>2</upper><effort>3</effort>"
                                   "</limit><dynamics><damping>0.1</damping><friction>0.2</friction><spring_stiffness>0.3"
                                   "</spring_stiffness><spring_reference>0.4</spring_reference></dynamics></axis>"));
  CHECK(j.name == "m::j");
  CHECK(j.kind == JointKind::kRevolute);
  CHECK(j.parent == 0);
  CHECK(j.child == 1);
  CHECK((j.anchor_m - Vector3d(0, 1, 2)).norm() < 1e-9);  // origin of the child, x of the model is y of the world
  CHECK((j.axes[0].axis - Vector3d::UnitY()).norm() < 1e-9);
  CHECK(j.axes[0].lower == -1);
  CHECK(j.axes[0].upper == 2);
  CHECK(j.axes[0].effort == 3);
  CHECK(j.axes[0].damping == 0.1);
  CHECK(j.axes[0].friction == 0.2);
  CHECK(j.axes[0].stiffness == 0.3);
  CHECK(j.axes[0].reference == 0.4);
}

TEST_CASE("Every supported joint type is read") {
  CHECK(joint(jointed("fixed", "")).kind == JointKind::kFixed);
  CHECK(joint(jointed("ball", "")).kind == JointKind::kBall);
  CHECK(joint(jointed("prismatic", kAxis)).kind == JointKind::kPrismatic);
  const JointDef continuous = joint(jointed("continuous", "<axis><xyz>0 0 1</xyz><limit><lower>-1</lower></limit></axis>"));
  CHECK(continuous.kind == JointKind::kRevolute);
  CHECK(continuous.axes[0].lower <= -1e15);
  CHECK(continuous.axes[0].effort == -1);
  const JointDef universal = joint(jointed("universal", kAxis + "<axis2><xyz>0 2 0</xyz></axis2>"));
  CHECK(universal.kind == JointKind::kUniversal);
  CHECK((universal.axes[0].axis - Vector3d::UnitY()).norm() < 1e-9);
  CHECK((universal.axes[1].axis + Vector3d::UnitX()).norm() < 1e-9);
}

TEST_CASE("A joint pose is in the child frame, and an axis in the frame that expresses it") {
  const JointDef j = joint(jointed("revolute", "<pose>0 0 0.5 0 0 1.5707963267948966</pose><axis><xyz>1 0 0</xyz></axis>"));
  CHECK((j.anchor_m - Vector3d(0, 1, 2.5)).norm() < 1e-9);
  CHECK((j.axes[0].axis + Vector3d::UnitX()).norm() < 1e-9);  // two quarter turns
  const JointDef k = joint(jointed("revolute", "<pose>0 0 0.5 0 0 1.5707963267948966</pose><axis><xyz expressed_in='__model__'>"
                                   "1 0 0</xyz></axis>"));
  CHECK((k.axes[0].axis - Vector3d::UnitY()).norm() < 1e-9);
}

TEST_CASE("Joints to the world and into nested models are read, and connected pairs do not collide") {
  SceneFile file(model("<self_collide>true</self_collide><link name='a'/><model name='n'><link name='b'/></model>"
                       "<joint name='j' type='fixed'><parent>world</parent><child>a</child></joint>"
                       "<joint name='k' type='ball'><parent>a</parent><child>n::b</child></joint>"));
  const WorldDef w = file.load();
  REQUIRE(w.joints.size() == 2);
  CHECK(w.joints[0].parent == -1);
  CHECK(w.joints[1].child == 1);
  CHECK(w.no_collision == std::vector<std::pair<int, int>>{{0, 1}});
}

TEST_CASE("A motor applies a constant torque to an axis") {
  const JointDef j = joint(jointed("revolute", kAxis + "<tactus:motor torque='-0.5'/>"));
  CHECK(j.axes[0].motor_effort == 0.5);
  CHECK(j.axes[0].motor_velocity < -100);
  const JointDef p = joint(jointed("prismatic", kAxis + "<tactus:motor force='2N' velocity='10mm/s'/>"));
  CHECK(p.axes[0].motor_effort == 2);
  CHECK(p.axes[0].motor_velocity == Approx(0.01));
  const JointDef u = joint(jointed("universal", kAxis + "<axis2><xyz>0 1 0</xyz></axis2><tactus:motor axis='2' torque='1'/>"));
  CHECK(u.axes[0].motor_effort == 0);
  CHECK(u.axes[1].motor_effort == 1);
}

TEST_CASE("Limits that exclude the start of a joint are warned of with their line") {
  const auto warnings = [](const std::string& limits) {
    SceneFile file(jointed("revolute", "<axis><xyz>1 0 0</xyz><limit>" + limits + "</limit></axis>"));
    file.load();
    return file.warnings;
  };
  CHECK(warnings("<lower>-1</lower><upper>1</upper>").empty());
  CHECK(warnings("<lower>0</lower><upper>1</upper>").empty());
  for (const std::string limits : {"<lower>0.5</lower><upper>1</upper>", "<lower>-3</lower><upper>-0.1</upper>"}) {
    const auto found = warnings(limits);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Catch::Contains("scene.sdf:6: ") && Catch::Contains("excludes 0, at which the joint starts"));
  }
}

TEST_CASE("An invalid joint is rejected with its line") {
  const auto load_error = [](const std::string& type, const std::string& inside) {
    SceneFile file(jointed(type, inside));
    return file.load_error();
  };
  CHECK_THAT(load_error("revolute", "<axis><xyz>0 0 0</xyz></axis>"), Catch::StartsWith("scene.sdf:"));
  CHECK_THAT(load_error("revolute", "<axis><xyz>1 0 0</xyz><limit><lower>2</lower><upper>1</upper></limit></axis>"),
             Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("lower limit above"));
  CHECK_THAT(load_error("revolute", "<axis><xyz>1 0 0</xyz><dynamics><damping>-1</damping></dynamics></axis>"),
             Catch::StartsWith("scene.sdf:6: "));
  CHECK_THAT(load_error("universal", kAxis), Catch::Contains("scene.sdf:"));
  CHECK_THAT(load_error("universal", kAxis + "<axis2><xyz>1 0 0</xyz></axis2>"), Catch::Contains("two axes in one direction"));
  CHECK_THAT(load_error("ball", "<tactus:motor torque='1'/>"), Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("without an axis"));
  CHECK_THAT(load_error("revolute", kAxis + "\n<tactus:motor/>"), Catch::StartsWith("scene.sdf:7: ") && Catch::Contains("torque"));
  CHECK_THAT(load_error("revolute", kAxis + "\n<tactus:motor torque='1' speed='2'/>"), Catch::Contains("no attribute \"speed\""));
}

TEST_CASE("An unsupported joint type is omitted with one warning") {
  SceneFile file(jointed("screw", kAxis));
  CHECK(file.load().joints.empty());
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], Catch::Contains("scene.sdf:5: ") && Catch::Contains("screw"));
}
