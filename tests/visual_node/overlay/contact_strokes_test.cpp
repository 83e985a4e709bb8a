#include "visual_node/overlay/contact_strokes.h"

#include <catch2/catch.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>

using namespace tactus;
using namespace tactus::visual;

namespace {

contact_t contact(int points, int tool) {
  contact_t c{};
  c.tool = tool;
  c.normal.z = 1;
  c.normal_force_N = 3;
  for (int i = 0; i < points; ++i) {
    contact_point_t p{};
    p.a_world_m.x = p.b_world_m.x = static_cast<float>(i);
    p.a_world_m.z = 0.1f, p.b_world_m.z = 0.3f;
    c.points.push_back(p);
  }
  c.point_count = static_cast<std::int8_t>(points);
  return c;
}

}  // namespace

TEST_CASE("Each point of a contact has a cross and a normal midway between the surfaces") {
  std::vector<Stroke> strokes;
  append_contacts(strokes, std::vector{contact(2, -1)});
  REQUIRE(strokes.size() == 2 * 4);
  CHECK(strokes[3].from.head<3>().isApprox(Eigen::Vector3f(0, 0, 0.2f)));
  CHECK(strokes[3].to.head<3>().isApprox(Eigen::Vector3f(0, 0, 0.2f + kNormal_m)));
  CHECK(strokes[7].from.head<3>().isApprox(Eigen::Vector3f(1, 0, 0.2f)));
  std::vector<Stroke> of_tool;
  append_contacts(of_tool, std::vector{contact(1, 0)});
  CHECK(of_tool[0].colour != strokes[0].colour);
}

TEST_CASE("A force arrow has a length of force times scale and starts at the middle of the contact") {
  std::vector<Stroke> strokes;
  append_contact_forces(strokes, std::vector{contact(3, -1)}, 0.02f);
  REQUIRE(!strokes.empty());
  CHECK(strokes[0].from.head<3>().isApprox(Eigen::Vector3f(1, 0, 0.2f)));
  CHECK((strokes[0].to - strokes[0].from).head<3>().norm() == Approx(0.06));
  strokes.clear();
  const Eigen::Vector3d force_N(0, -2, 0);
  ToolPose pose;
  append_hand_force(strokes, pose, force_N, 0.02f);
  CHECK(strokes.empty());  // its place is unknown
  pose.known = true;
  pose.proxy.translation() = Eigen::Vector3d(1, 2, 3);
  append_hand_force(strokes, pose, force_N, 0.02f);
  REQUIRE(!strokes.empty());
  CHECK(strokes[0].to.head<3>().isApprox(Eigen::Vector3f(1, 1.96f, 3)));
}

TEST_CASE("A spring is drawn between proxy and device when they are apart") {
  ToolPose pose;
  std::vector<Stroke> strokes;
  append_tool(strokes, pose);
  CHECK(strokes.empty());
  pose.known = true;
  append_tool(strokes, pose);
  CHECK(strokes.size() == 6);
  strokes.clear();
  pose.device.translation().x() = 0.01;
  append_tool(strokes, pose);
  CHECK(strokes.size() == 6 + 2 * kSpringTurns + 1);
}

TEST_CASE("The number of lines is limited for any number of contacts") {
  std::vector<Stroke> strokes;
  append_contacts(strokes, std::vector(kMaxContactsDrawn + 500, contact(4, -1)));
  CHECK(strokes.size() == kMaxContactsDrawn * 16);
}
