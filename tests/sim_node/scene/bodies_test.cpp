#include "sim_node/scene/bodies.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
const std::string kLinkBall = collision("<sphere><radius>0.1</radius></sphere>");
bool same(const Vector3d& a, const Vector3d& b) { return (a - b).norm() < 1e-9; }
}  // namespace

TEST_CASE("Poses of nested models and frames are resolved correctly") {
  SceneFile file(world(R"(<model name="outer"><pose>1 0 0 0 0 1.5707963267948966</pose>
      <frame name="shelf"><pose>0 0 2 0 0 0</pose></frame>
      <link name="base"><pose relative_to="shelf">0.5 0 0 0 0 0</pose></link>
      <model name="inner"><pose>1 0 0 0 0 1.5707963267948966</pose>
        <link name="tip"><pose>1 0 3 0 0 0</pose></link>
      </model></model>)"));
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 2);
  CHECK(w.bodies[0].name == "outer::base");
  CHECK(same(w.bodies[0].pose.translation(), {1, 0.5, 2}));  // x of the model is y of the world
  CHECK(w.bodies[1].name == "outer::inner::tip");
  CHECK(same(w.bodies[1].pose.translation(), {0, 1, 3}));  // (1,0,0) + y*1 + (turned twice: -x)*1
  CHECK(same(w.bodies[1].pose.linear() * Vector3d::UnitX(), -Vector3d::UnitX()));
  CHECK(file.warnings.empty());
}

TEST_CASE("A static model and its nested models never move") {
  SceneFile file(world(R"(<model name="a"><static>true</static><link name="l"/>
      <model name="b"><link name="l"/></model></model><model name="c"><link name="l"/></model>)"));
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 3);
  CHECK(w.bodies[0].is_static);
  CHECK(w.bodies[1].is_static);
  CHECK(w.bodies[0].mass_kg == 0);
  CHECK_FALSE(w.bodies[2].is_static);
}

TEST_CASE("Friction and restitution come from SDF, then from the material, then from the defaults") {
  SceneFile file(link("<collision name='none'><geometry><sphere><radius>1</radius></sphere></geometry></collision>"
                      "<collision name='oak'><tactus:surface material='oak'/><geometry><sphere><radius>1</radius></sphere>"
                      "</geometry></collision><collision name='both'><tactus:surface material='oak'/><geometry><sphere>"
                      "<radius>1</radius></sphere></geometry><surface><friction><ode><mu>0.25</mu></ode></friction><bounce>"
                      "<restitution_coefficient>0.5</restitution_coefficient></bounce></surface></collision>"));
  const WorldDef w = file.load();
  REQUIRE(w.shapes.size() == 3);
  CHECK(w.shapes[0].friction == 1);
  CHECK(w.shapes[0].restitution == 0);
  CHECK(w.shapes[0].material == -1);
  const auto& oak = w.materials[static_cast<std::size_t>(w.shapes[1].material)];
  CHECK(oak.name == "oak");
  CHECK(w.shapes[1].friction == oak.friction_dynamic);
  CHECK(w.shapes[1].restitution == oak.restitution);
  CHECK(w.shapes[2].friction == 0.25);
  CHECK(w.shapes[2].restitution == 0.5);
}

TEST_CASE("The innermost surface setting applies, from collision over link to model") {
  SceneFile file(model("<tactus:surface material='steel'/><link name='a'>" + kLinkBall +
                       "</link><link name='b'><tactus:surface material='oak'/>" + kLinkBall +
                       "<collision name='d'><tactus:surface material='glass'/><geometry><box><size>1 1 1</size></box>"
                       "</geometry></collision></link>"));
  const WorldDef w = file.load();
  const auto name = [&](std::size_t i) { return w.materials[static_cast<std::size_t>(w.shapes[i].material)].name; };
  CHECK(name(0) == "steel");
  CHECK(name(1) == "oak");
  CHECK(name(2) == "glass");
}

TEST_CASE("A body with visuals only gets the bounding box of its visuals") {
  SceneFile file(link("<visual name='v'><pose>0 0 1 0 0 0</pose><geometry><sphere><radius>0.5</radius></sphere></geometry>"
                      "</visual><visual name='u'><pose>2 0 0 0 1.5707963267948966 0</pose><geometry><cylinder><radius>0.1"
                      "</radius><length>2</length></cylinder></geometry></visual>"));
  const WorldDef w = file.load();
  REQUIRE(w.shapes.size() == 1);
  // The sphere spans x -0.5..0.5, z 0.5..1.5; the cylinder lies along x: 1..3, y and z -0.1..0.1.
  CHECK(w.shapes[0].kind == ShapeKind::kBox);
  CHECK(same(w.shapes[0].pose.translation(), {1.25, 0, 0.7}));
  CHECK(same(w.shapes[0].size_m, {3.5, 1, 1.6}));
}

TEST_CASE("Links of a model collide with each other only if the model or a link allows it") {
  const auto pairs = [](const std::string& more, const std::string& in_b = "") {
    SceneFile file(model(more + "<link name='a'/><link name='b'>" + in_b + "</link><link name='c'/>"));
    return file.load().no_collision;
  };
  CHECK(pairs("") == std::vector<std::pair<int, int>>{{0, 1}, {0, 2}, {1, 2}});
  CHECK(pairs("<self_collide>true</self_collide>").empty());
  CHECK(pairs("", "<self_collide>true</self_collide>") == std::vector<std::pair<int, int>>{{0, 2}});
}

TEST_CASE("Gravity and velocity decay of a link are read") {
  SceneFile file(link("<gravity>false</gravity><velocity_decay><linear>0.25</linear><angular>0.5</angular></velocity_decay>"));
  const WorldDef w = file.load();
  CHECK_FALSE(w.bodies[0].gravity);
  CHECK(w.bodies[0].linear_damping_1_s == 0.25);
  CHECK(w.bodies[0].angular_damping_1_s == 0.5);
}

TEST_CASE("An SDF 1.4 file with old spellings loads") {
  SceneFile file(world("<gravity>0 0 -3.7</gravity><model name='m'><pose>0 0 1 0 3.141592653589793 0</pose><link name='l'>" +
                           kLinkBall + "</link></model>",
                       "1.4"));
  const WorldDef w = file.load();
  CHECK(same(w.gravity_m_s2, {0, 0, -3.7}));
  CHECK(same(w.bodies[0].pose.linear() * Vector3d::UnitZ(), -Vector3d::UnitZ()));
}

TEST_CASE("A link starts with the velocity and spin that the scene gives it") {
  SceneFile file(world("<model name=\"m\"><link name=\"l\"><tactus:velocity>0.5 -1 2</tactus:velocity>"
                       "<tactus:spin>0 0 3.5</tactus:spin>" + kLinkBall + "</link></model>"));
  const WorldDef w = file.load();
  REQUIRE(w.bodies.size() == 1);
  CHECK(same(w.bodies[0].velocity_m_s, {0.5, -1, 2}));
  CHECK(same(w.bodies[0].spin_rad_s, {0, 0, 3.5}));
  CHECK(file.warnings.empty());
  SceneFile wrong(world("<model name=\"m\"><link name=\"l\"><tactus:velocity>0.5 -1</tactus:velocity></link></model>"));
  CHECK_THROWS_WITH(wrong.load(), Catch::Contains("must be 3 numbers"));
}
