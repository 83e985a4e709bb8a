#include "sim_node/scene/inertial.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
const std::string kBall = collision("<sphere><radius>0.1</radius></sphere>");
BodyDef body(const std::string& inside) {
  SceneFile file(link(inside));
  return file.load().bodies.front();
}
std::string inertial(const std::string& inside) { return "<inertial>" + inside + "</inertial>"; }
std::string inertia(double x, double y, double z) {
  return "<inertia><ixx>" + std::to_string(x) + "</ixx><iyy>" + std::to_string(y) + "</iyy><izz>" + std::to_string(z) +
         "</izz></inertia>";
}
}  // namespace

TEST_CASE("Mass and inertia are used as given at their own pose") {
  const BodyDef b = body(inertial("<pose>0.1 0 0 0 0 1.5707963267948966</pose><mass>2</mass>" + inertia(1, 2, 2.5)) + kBall);
  CHECK(b.mass_kg == 2);
  CHECK((b.centre_of_mass_m - Vector3d(0.1, 0, 0)).norm() < 1e-12);
  CHECK((b.inertia_kg_m2.diagonal() - Vector3d(2, 1, 2.5)).norm() < 1e-9);  // turned by a quarter about z
}

TEST_CASE("Missing values are computed from the shapes") {
  CHECK(body(kBall).mass_kg == 1);  // SDF's default
  CHECK(body(kBall).inertia_kg_m2(0, 0) == Approx(0.4 * 0.01));
  CHECK(body(inertial("<mass>3</mass>") + kBall).inertia_kg_m2(1, 1) == Approx(3 * 0.4 * 0.01));
  const BodyDef steel = body("<tactus:surface material='steel'/>" + kBall);
  CHECK(steel.mass_kg == Approx(7850 * 4.0 / 3 * EIGEN_PI * 1e-3));
  CHECK(body("").mass_kg == 1);
  CHECK(body("").inertia_kg_m2(0, 0) == 1);
}

TEST_CASE("An impossible mass or inertia is rejected with its line") {
  const auto load_error = [](const std::string& inside) {
    SceneFile file(link(inside + kBall));
    return file.load_error();
  };
  for (const char* mass : {"0", "-1", "nan", "inf"}) {
    INFO(mass);
    CHECK_THAT(load_error("<inertial>\n<mass>" + std::string(mass) + "</mass></inertial>"), Catch::StartsWith("scene.sdf:"));
  }
  CHECK_THAT(load_error(inertial("\n<mass>0</mass>")), Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("above 0 kg"));
  CHECK_THAT(load_error(inertial("<mass>1</mass>\n" + inertia(1, 0, 1))), Catch::StartsWith("scene.sdf:6: ") &&
                                                                          Catch::Contains("not positive definite"));
}

TEST_CASE("The mass of a static model is not validated") {
  SceneFile file(model("<static>true</static><link name='l'>" + inertial("<mass>0</mass>") + kBall + "</link>"));
  CHECK(file.load().bodies.front().mass_kg == 0);
}

TEST_CASE("An inertia that violates the triangle inequality is used with a warning") {
  SceneFile file(link(inertial("<mass>1</mass>\n" + inertia(1, 1, 3)) + kBall));
  CHECK(file.load().bodies.front().inertia_kg_m2(2, 2) == 3);
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], Catch::Contains("scene.sdf:6: ") && Catch::Contains("not physically possible"));
}
