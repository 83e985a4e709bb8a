// Numbers, flags, colours and poses of elements, and rejected values.
#include "sim_node/scene/sdf/values.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tactus::sim;

namespace {

struct OneElement {
  sdf::Source source{"/w/scene.sdf", "scene.sdf", 9};
  std::string text;
  sdf::Element element;
  explicit OneElement(const std::string& written, std::vector<sdf::Attribute> attributes = {}) : text(written) {
    element.name = "pose", element.text = sdf::trimmed(text), element.source = &source, element.line = 3;
    element.attributes = std::move(attributes);
  }
};

double read_number(const std::string& text) { return sdf::number(OneElement(text).element); }

}  // namespace

TEST_CASE("A number is read as a whole, in every spelling of XML files") {
  CHECK(read_number(" 1.5 ") == 1.5);
  CHECK(read_number("+2") == 2);
  CHECK(read_number("-.5") == -0.5);
  CHECK(read_number("5.") == 5);
  CHECK(read_number("1E-3") == 1e-3);
  CHECK(std::isinf(sdf::number_or_infinity(OneElement("inf").element)));
  CHECK(sdf::number_or_infinity(OneElement("-INF").element) < -1e300);
}

TEST_CASE("A value that is not a finite number is rejected with file, line and path") {
  for (const char* text : {"", "heavy", "1.5kg", "1,5", "nan", "inf", "-inf", "1e999", "1 2", "0x10", "++1", "+-1", "--1", "1e", "."}) {
    INFO(text);
    CHECK_THROWS_WITH(read_number(text), Catch::StartsWith("scene.sdf:3: /pose = \"" + std::string(text)));
  }
  CHECK_THROWS(sdf::number_or_infinity(OneElement("nan").element));
}

TEST_CASE("Vectors have exactly their number of finite numbers") {
  CHECK(sdf::vector3(OneElement("1\n 2\t3").element) == Eigen::Vector3d(1, 2, 3));
  CHECK(sdf::vector2(OneElement("1 2").element) == Eigen::Vector2d(1, 2));
  for (const char* text : {"", "1 2", "1 2 3 4", "1 2 nan", "1 2 x", "1;2;3"}) {
    INFO(text);
    CHECK_THROWS_WITH(sdf::vector3(OneElement(text).element), Catch::StartsWith("scene.sdf:3: "));
  }
}

TEST_CASE("Flags are true, false, 1 or 0 in any case of letters") {
  for (const char* text : {"true", "True", "TRUE", "1"}) CHECK(sdf::flag(OneElement(text).element));
  for (const char* text : {"false", "False", "0"}) CHECK_FALSE(sdf::flag(OneElement(text).element));
  for (const char* text : {"", "yes", "2", "truely"}) CHECK_THROWS(sdf::flag(OneElement(text).element));
}

TEST_CASE("Colours have three or four numbers of 0 to 1") {
  const sdf::Colour c = sdf::colour(OneElement("0.25 0.5 1").element);
  CHECK(c.rgb == Eigen::Vector3d(0.25, 0.5, 1));
  CHECK(c.alpha == 1);
  CHECK(sdf::colour(OneElement("0 0 0 0.5").element).alpha == 0.5);
  for (const char* text : {"", "1 1", "1 1 1 1 1", "255 0 0", "-1 0 0", "nan 0 0"}) {
    INFO(text);
    CHECK_THROWS_WITH(sdf::colour(OneElement(text).element), Catch::StartsWith("scene.sdf:3: "));
  }
}

TEST_CASE("A pose is given in radians, in degrees or as a quaternion") {
  const double half = std::sqrt(0.5);
  const OneElement rad("1 2 3 0 0 1.5707963267948966");
  const OneElement degrees("1 2 3 0 0 90", {{"degrees", "true"}});
  const OneElement quaternion("1 2 3 0 0 0.70710678118654752 0.70710678118654752", {{"rotation_format", "quat_xyzw"}});
  const OneElement scaled("1 2 3 0 0 5 5", {{"rotation_format", "quat_xyzw"}});
  for (const OneElement* each : {&rad, &degrees, &quaternion, &scaled}) {
    const sdf::Pose pose = sdf::raw_pose(each->element);
    CHECK(pose.position_m == Eigen::Vector3d(1, 2, 3));
    CHECK(std::abs(pose.rotation.w - half) < 1e-15);
    CHECK(std::abs(pose.rotation.z - half) < 1e-15);
  }
  CHECK(sdf::raw_pose(OneElement("").element).to_eigen().matrix() == Eigen::Matrix4d::Identity());
  using Attributes = std::vector<sdf::Attribute>;
  for (const auto& [text, attributes] : {std::pair<const char*, Attributes>{"0 0 0 0 0", {}},
                                         {"0 0 0 0 0 0 0", {}},
                                         {"0 0 0 0 0 nan", {}},
                                         {"0 0 0 0 0 0", {{"degrees", "perhaps"}}},
                                         {"0 0 0 0 0 0", {{"rotation_format", "quat_wxyz"}}},
                                         {"0 0 0 0 0 0", {{"rotation_format", "quat_xyzw"}}},
                                         {"0 0 0 0 0 0 0", {{"rotation_format", "quat_xyzw"}}},
                                         {"0 0 0 0 0 0 1", {{"rotation_format", "quat_xyzw"}, {"degrees", "1"}}}}) {
    INFO(text);
    CHECK_THROWS_WITH(sdf::raw_pose(OneElement(text, attributes).element), Catch::StartsWith("scene.sdf:3: "));
  }
}

TEST_CASE("Poses compose as rigid motions") {
  const sdf::Pose a{{1, 2, 3}, sdf::Rotation::from_euler(0.3, -0.4, 2)}, b{{-2, 0.5, 1}, sdf::Rotation::from_euler(-1, 0.2, 0.7)};
  // The arguments are below 5, so that rounding stays below 1e-14.
  CHECK(((a * b).to_eigen().matrix() - (a.to_eigen() * b.to_eigen()).matrix()).norm() < 1e-14);
  CHECK(((a.inverse() * a).to_eigen().matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-14);
  const Eigen::Vector3d v(0.1, -2, 3);
  CHECK((a.rotation * v - a.to_eigen().linear() * v).norm() < 1e-14);
}
