#include "visual_node/lens/wall.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

using namespace tactus::visual;
using Eigen::Vector3d;

namespace {

const std::string kHead =
    "wall,lower_left_x_m,lower_left_y_m,lower_left_z_m,lower_right_x_m,lower_right_y_m,lower_right_z_m,"
    "upper_left_x_m,upper_left_y_m,upper_left_z_m\n";

}  // namespace

TEST_CASE("The walls of a cave face the user and share their edges") {
  const auto [name, walls, open_edges] =
      GENERATE(std::tuple("cave4", 4, 6), std::tuple("cave6", 6, 0), std::tuple("desk", 1, 4));
  const Room room = load_room(name);
  REQUIRE(room.walls.size() == static_cast<std::size_t>(walls));
  const Vector3d person = name == std::string("desk") ? Vector3d(-0.6, 0, 0) : Vector3d(0, 0, 1.7);
  // An edge as its two ends, shared with another wall or open.
  const auto key = [](const Vector3d& v) {
    const auto mm = [](double m) { return std::to_string(std::lround(1e3 * m)) + " "; };
    return mm(v.x()) + mm(v.y()) + mm(v.z());
  };
  std::multiset<std::string> edges;
  for (const Wall& w : room.walls) {
    CAPTURE(w.name);
    CHECK((person - w.lower_left).dot(w.normal()) > 0.1);
    const Vector3d upper_right = w.lower_right + w.upper_left - w.lower_left;
    const std::array<Vector3d, 5> around{w.lower_left, w.lower_right, upper_right, w.upper_left, w.lower_left};
    for (std::size_t i = 0; i < 4; ++i)
      edges.insert(std::min(key(around[i]), key(around[i + 1])) + std::max(key(around[i]), key(around[i + 1])));
  }
  int alone = 0;
  for (const std::string& edge : edges) {
    CHECK(edges.count(edge) <= 2);
    alone += edges.count(edge) == 1;
  }
  CHECK(alone == open_edges);
}

TEST_CASE("A custom room is read from a file, and an invalid one is rejected with a message") {
  const Room room = parse_room(kHead + "tilted,1,0.5,0,1,-0.5,0,1.6,0.5,0.8\r\n\n", "mine");
  REQUIRE(room.walls.size() == 1);
  CHECK(room.find_wall("tilted") == &room.walls[0]);
  CHECK(room.find_wall("front") == nullptr);
  CHECK(room.walls[0].width_m() == Approx(1));
  CHECK(room.walls[0].height_m() == Approx(1));
  CHECK((room.walls[0].normal() - Vector3d(-0.8, 0, 0.6)).norm() < 1e-12);

  const auto expect_rejection = [](const std::string& rows, const std::string& why) {
    CHECK_THROWS_WITH(parse_room(rows, "mine"), Catch::StartsWith("the room mine ") && Catch::Contains(why));
  };
  expect_rejection("", "does not begin in line 1");
  expect_rejection(kHead + "\n\na,1,2,3\n", "ten columns in line 4");
  expect_rejection(kHead, "has no wall");
  expect_rejection(kHead + "a,1,2,3\n", "does not have ten columns");
  expect_rejection(kHead + "a,1,0.5,0,1,-0.5,0,1,0.5,nan\n", "nine numbers");
  expect_rejection(kHead + "a,1,0.5,0,1,-0.5,0,1,0.5,1e999\n", "nine numbers");
  expect_rejection(kHead + ",1,0.5,0,1,-0.5,0,1,0.5,1\n", "does not have a name");
  expect_rejection(kHead + "a,1,0.5,0,1,-0.5,0,1,0.4,1\n", "does not have a rectangle");
  expect_rejection(kHead + "a,1,0.5,0,1,0.5,0,1,0.5,1\n", "does not have a rectangle");
  expect_rejection(kHead + "a,1,0.5,0,1,-0.5,0,1,0.5,1\na,2,0.5,0,2,-0.5,0,2,0.5,1\n", "two walls a");
  // Endless files are rejected too; a scene might name one.
  for (const char* path : {"/no/such/room.csv", "/dev/zero", "/tmp"})
    CHECK_THROWS_WITH(load_room(path), Catch::Contains("cannot be read"));
}

TEST_CASE("A moved wall keeps its size and rotates its normal") {
  const Wall front = *load_room("cave4").find_wall("front");
  const Eigen::Isometry3d by = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ());
  const Wall there = moved(front, by);
  CHECK(there.width_m() == Approx(front.width_m()));
  CHECK((there.normal() - by.linear() * front.normal()).norm() < 1e-12);
  CHECK((there.lower_left - by * front.lower_left).norm() < 1e-12);
}
