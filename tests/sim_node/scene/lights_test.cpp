#include <tactus/light_def_t.hpp>

#include "sim_node/scene/lights.h"

#include "lcmtypes/vectors.h"
#include "tests/sim_node/support/scene_file.h"

using namespace tactus;
using namespace tactus::sim;
using Eigen::Vector3d;

TEST_CASE("A spot light has its cone, colour, attenuation and direction") {
  SceneFile file(world("<light name='s' type='spot'><pose>1 2 3 0 1.5707963267948966 0</pose><diffuse>1 0.5 0.25 1</diffuse>"
                       "<specular>0.1 0.2 0.3 1</specular><intensity>2</intensity><cast_shadows>true</cast_shadows><direction>"
                       "0 0 -2</direction><attenuation><range>7</range><constant>0.5</constant><linear>0.25</linear><quadratic>"
                       "0.125</quadratic></attenuation><spot><inner_angle>0.5</inner_angle><outer_angle>0.75</outer_angle>"
                       "<falloff>2</falloff></spot></light>"));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  REQUIRE(w.lights.size() == 1);
  const light_def_t& l = w.lights[0];
  CHECK(l.kind == light_def_t::SPOT);
  CHECK((to_eigen(l.pose).translation() - Vector3d(1, 2, 3)).norm() < 1e-9);
  CHECK((to_eigen(l.direction) - Vector3d(-1, 0, 0)).norm() < 1e-9);  // -z turned by a quarter about y
  CHECK(l.diffuse.y == 0.5f);
  CHECK(l.specular.z == 0.3f);
  CHECK(l.intensity == 2);
  CHECK(l.casts_shadow == 1);
  CHECK(l.range_m == 7);
  CHECK(l.attenuation_constant == 0.5f);
  CHECK(l.attenuation_linear == 0.25f);
  CHECK(l.attenuation_quadratic == 0.125f);
  CHECK(l.inner_angle_rad == 0.5f);
  CHECK(l.outer_angle_rad == 0.75f);
  CHECK(l.falloff == 2);
}

TEST_CASE("Point and directional lights and a light on a static link are read") {
  SceneFile file(world("<light name='p' type='point'/><light name='d' type='directional'><direction>0 1 -1</direction></light>"
                       "<model name='m'><static>true</static><pose>0 0 1 0 0 0</pose><link name='l'><light name='q' type='point'>"
                       "<pose>0 0 1 0 0 0</pose></light></link></model>"));
  const WorldDef w = file.load();
  REQUIRE(w.lights.size() == 3);
  CHECK(w.lights[0].kind == light_def_t::POINT);
  CHECK(w.lights[1].kind == light_def_t::DIRECTIONAL);
  CHECK(w.lights[2].pose.position_m.z == 2);
  CHECK(file.warnings.empty());
}

TEST_CASE("A world without a light has a directional default light") {
  SceneFile file(world(""));
  CHECK(file.load().lights.size() == 1);
}

TEST_CASE("An invalid light is rejected with its line") {
  SceneFile file(world("<light name='p' type='point'>\n<intensity>-1</intensity></light>"));
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("intensity"));
}
