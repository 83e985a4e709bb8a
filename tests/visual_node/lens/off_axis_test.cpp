#include "visual_node/lens/off_axis.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::visual;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int kWidth = 1024;
// Float matrices: 24 bits, some operations, sums of terms up to ten times the result.
constexpr double kFloatRounding = 2e-5;

Vector2d clip_position(const Camera& camera, const Vector3d& place) {
  const Eigen::Vector4d clip =
      (camera.projection.cast<double>() * camera.view.cast<double>()) * Vector3d(place - camera.origin_m).homogeneous();
  REQUIRE(clip.w() > 0);
  return clip.head<2>() / clip.w();
}

std::vector<Vector3d> heads() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-1.3, 1.3), height(0.3, 2.7);
  std::vector<Vector3d> all;
  for (int i = 0; i < 200; ++i) {
    const double x = across(random), y = across(random);
    all.emplace_back(x, y, height(random));
  }
  return all;
}

const Room& cave() {
  static const Room room = load_room("cave6");
  return room;
}

}  // namespace

TEST_CASE("The corners of a wall map to those of its picture for every head position") {
  for (const Wall& wall : cave().walls)
    for (const Vector3d& head : heads()) {
      CAPTURE(wall.name, head.transpose());
      const Camera camera = off_axis(wall, head, kWidth, 0.02, 100);
      CHECK((clip_position(camera, wall.lower_left) - Vector2d(-1, -1)).norm() < kFloatRounding);
      CHECK((clip_position(camera, wall.lower_right) - Vector2d(1, -1)).norm() < kFloatRounding);
      CHECK((clip_position(camera, wall.upper_left) - Vector2d(-1, 1)).norm() < kFloatRounding);
      // Depth along the normal of the wall: from the near plane to the far one.
      const auto depth = [&](double away_m) {
        const Eigen::Vector4d clip =
            camera.clip_from_world().cast<double>() * (head - away_m * wall.normal()).homogeneous();
        return clip.z() / clip.w();
      };
      CHECK(depth(0.02) == Approx(-1).margin(1e-3));
      CHECK(depth(100) == Approx(1).margin(1e-3));
    }
}

TEST_CASE("Points behind an edge of two walls lie on matching pixels of both walls") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1), far(1, 20);
  int edges = 0;
  for (const Wall& a : cave().walls)
    for (const Wall& b : cave().walls) {
      // The shared ends.
      std::vector<Vector3d> ends;
      for (const Wall* one : {&a})
        for (const Vector3d& corner : {one->lower_left, one->lower_right, one->upper_left,
                                       Vector3d(one->lower_right + one->upper_left - one->lower_left)})
          for (const Vector3d& other :
               {b.lower_left, b.lower_right, b.upper_left, Vector3d(b.lower_right + b.upper_left - b.lower_left)})
            if ((corner - other).norm() < 1e-9) ends.push_back(corner);
      if (&a == &b || ends.size() != 2) continue;
      ++edges;
      for (const Vector3d& head : heads()) {
        const Vector3d on_edge = ends[0] + share(random) * (ends[1] - ends[0]);
        const Vector3d behind = head + far(random) * (on_edge - head);
        const auto place = [&](const Wall& wall) {
          const Vector2d p = clip_position(off_axis(wall, head, kWidth, 0.02, 100), behind);
          // Projected back onto the wall: the same place of the room.
          const Vector3d on_wall = wall.lower_left + 0.5 * (p.x() + 1) * (wall.lower_right - wall.lower_left) +
                                   0.5 * (p.y() + 1) * (wall.upper_left - wall.lower_left);
          return on_wall;
        };
        CAPTURE(a.name, b.name, head.transpose());
        // A hundredth of a pixel.
        CHECK((place(a) - place(b)).norm() < 0.01 * a.width_m() / kWidth);
        CHECK((place(a) - on_edge).norm() < 0.01 * a.width_m() / kWidth);
      }
    }
  CHECK(edges == 24);  // twelve, from either side
}

TEST_CASE("An eye in front of the centre of a wall has a symmetric perspective") {
  const Wall wall = *cave().find_wall("front");
  const double away = 1.524, height = 1.524;
  const Camera off = off_axis(wall, {0, 0, height}, kWidth, 0.02, 100);
  const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, height));
  const Camera plain = make_camera(pose, 2 * std::atan(0.5 * wall.width_m() / away), kWidth, kWidth, 0.02, 100);
  CHECK((off.projection - plain.projection).norm() < 1e-5f);
  CHECK((off.view - plain.view).norm() < 1e-5f);
  CHECK((off.eye - plain.eye).norm() < 1e-6f);
  CHECK(off.focal_px == Approx(plain.focal_px).epsilon(1e-5));
}

TEST_CASE("Both eyes see a point on the wall at one place, nearer points crossed, farther ones uncrossed") {
  const double apart = 0.064;
  const Wall wall = *cave().find_wall("front");
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(-0.5, 0.5), turn(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d head = Eigen::Translation3d(across(random), across(random), 1.5 + across(random)) *
                                   Eigen::AngleAxisd(turn(random), Vector3d::UnitZ());
    const auto [left, right] = eyes(head, apart);
    CHECK((left - right).norm() == Approx(apart));
    const auto parallax = [&](const Vector3d& place) {
      return Vector2d(clip_position(off_axis(wall, right, kWidth, 0.02, 100), place) -
                      clip_position(off_axis(wall, left, kWidth, 0.02, 100), place));
    };
    const Vector3d on_wall(1.524, across(random), 1.5 + across(random));
    const Vector3d from_eyes = on_wall - head.translation();
    CHECK(parallax(on_wall).norm() < kFloatRounding);
    CHECK(parallax(head.translation() + 0.7 * from_eyes).x() < -1e-4);
    CHECK(parallax(head.translation() + 2 * from_eyes).x() > 1e-4);
  }
  // A level head that faces the wall, without toe-in: no vertical difference between the eyes. A point at
  // infinity is as far apart on the wall as the eyes.
  const auto [left, right] = eyes(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5)), apart);
  const Vector3d far(1e5, 3e4, 4e4);
  const Vector2d parallax =
      clip_position(off_axis(wall, right, kWidth, 0.02, 100), far) - clip_position(off_axis(wall, left, kWidth, 0.02, 100), far);
  CHECK(0.5 * wall.width_m() * parallax.x() == Approx(apart).epsilon(0.01));
  CHECK(std::abs(parallax.y()) < 2 * kFloatRounding);
}

TEST_CASE("An eye in the plane of a wall or behind it has a valid picture") {
  const Wall wall = *cave().find_wall("front");
  for (const double x : {1.524, 1.6, 50.0}) {
    const Camera camera = off_axis(wall, {x, 0.2, 1}, kWidth, 0.02, 100);
    CHECK(camera.projection.allFinite());
    CHECK(camera.view.allFinite());
    CHECK((clip_position(camera, wall.lower_left) - Vector2d(-1, -1)).norm() < 1e-3);
    CHECK((clip_position(camera, wall.upper_left) - Vector2d(-1, 1)).norm() < 1e-3);
  }
}
