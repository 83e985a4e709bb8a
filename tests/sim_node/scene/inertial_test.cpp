#include "sim_node/scene/inertial.h"

#include <algorithm>

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

// An L of 3 litres: corners of its outline, and a file in which its faces are polygons, divided or reversed.
std::string l_shape(bool divided, bool reversed) {
  constexpr double kOutline[6][2] = {{0, 0}, {0.2, 0}, {0.2, 0.1}, {0.1, 0.1}, {0.1, 0.2}, {0, 0.2}};
  std::string text;
  for (const double z : {0.0, 0.1})
    for (const auto& p : kOutline) text += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(z) + "\n";
  const auto face = [&](std::vector<int> corners) {
    if (reversed) std::reverse(corners.begin(), corners.end());
    text += "f";
    for (const int c : corners) text += " " + std::to_string(c);
    text += "\n";
  };
  if (divided) {
    // From the inner corner, from which the whole outline is visible.
    for (const auto& [a, b] : {std::pair{5, 6}, std::pair{6, 1}, std::pair{1, 2}, std::pair{2, 3}}) face({10, a + 6, b + 6}), face({4, b, a});
  } else {
    face({7, 8, 9, 10, 11, 12});
    face({6, 5, 4, 3, 2, 1});
  }
  for (int a = 1; a <= 6; ++a) {
    const int b = a % 6 + 1;
    if (divided)
      face({a, b, b + 6}), face({a, b + 6, a + 6});
    else
      face({a, b, b + 6, a + 6});
  }
  return text;
}
}  // namespace

TEST_CASE("An L of oak weighs 2.25 kg inside out, mirrored and with concave polygons") {
  for (const bool divided : {true, false})
    for (const bool reversed : {true, false})
      for (const char* scale : {"1 1 1", "1 1 -1", "-1 -1 -1"}) {
        INFO(divided << ' ' << reversed << ' ' << scale);
        SceneFile file(link("<tactus:surface material='oak'/>" +
                            collision("<mesh><uri>l.obj</uri><scale>" + std::string(scale) + "</scale></mesh>")));
        file.write("l.obj", l_shape(divided, reversed));
        CHECK(file.load().bodies.front().mass_kg == Approx(2.25).epsilon(1e-6));
        // A mesh that is inside out is turned for contact, and reported.
        CHECK(file.warnings.size() == static_cast<std::size_t>(reversed));
      }
}

TEST_CASE("The mass of an open mesh is reported with its line, unless mass and inertia are given") {
  const std::string mesh = collision("<mesh><uri>l.obj</uri></mesh>");
  std::string open = l_shape(true, false);
  open.erase(open.rfind("f "));
  SceneFile file(link("<tactus:surface material='oak'/>" + mesh));
  file.write("l.obj", open);
  CHECK(file.load().bodies.front().mass_kg == Approx(2.25).epsilon(1e-6));
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("mesh \"c\", which is open (3 edges") &&
                                           Catch::Contains("for the mass and the inertia"));
  SceneFile given(link(inertial("<mass>1</mass>" + inertia(1, 1, 1)) + mesh));
  given.write("l.obj", open);
  given.load();
  CHECK(given.warnings.empty());
}

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
