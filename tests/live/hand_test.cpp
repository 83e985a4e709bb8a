// Tests of the mouse as a hand: ray through a pixel, speed limit, release.
#include "scripts/live/hand.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>

#include "lcmtypes/vectors.h"
#include "tests/live/live_time.h"

using namespace tactus;
using namespace tactus::live;
using Eigen::Vector3d;
using tactus::test::at;

namespace {

constexpr double kAspect = 4.0 / 3;

scene_t scene(const Eigen::Isometry3d& camera = Eigen::Isometry3d::Identity(), double fov_rad = EIGEN_PI / 2) {
  scene_t s{};
  s.camera = to_pose(camera);
  s.camera_fov_rad = fov_rad;
  return s;
}
Vector3d place(const device_state_t& m) { return to_eigen(m.pose.position_m); }

}  // namespace

TEST_CASE("A point in the picture is a point on its view ray") {
  // A camera at the origin that looks along +x with 90 degrees from left to right: tan 45 degrees is 1.
  CHECK(unproject(scene(), kAspect, 0, 0, 2).isApprox(Vector3d(2, 0, 0)));
  CHECK(unproject(scene(), kAspect, 1, 0, 2).isApprox(Vector3d(2, -2, 0)));
  CHECK(unproject(scene(), kAspect, -1, 0, 2).isApprox(Vector3d(2, 2, 0)));
  CHECK(unproject(scene(), kAspect, 0, 1, 2).isApprox(Vector3d(2, 0, 1.5)));

  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
    camera.translate(5 * Vector3d(unit(random), unit(random), unit(random)));
    camera.rotate(Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized());
    const double fov = 1.2 + unit(random), x = unit(random), y = unit(random), depth = 5.1 + 5 * unit(random);
    // Projected again with a pinhole camera, by the focal length in half widths.
    const Vector3d p = camera.inverse() * unproject(scene(camera, fov), kAspect, x, y, depth);
    const double focal = 1 / std::tan(fov / 2);
    REQUIRE(p.x() == Approx(depth));
    REQUIRE(-p.y() / p.x() * focal == Approx(x).margin(1e-9));
    REQUIRE(p.z() / p.x() * focal * kAspect == Approx(y).margin(1e-9));
  }
}

TEST_CASE("The hand starts at the tool and follows the mouse in the tool's plane, up to its speed limit") {
  Hand hand;
  const Vector3d tool(0.5, 0.1, -0.05);
  hand.aim({0.4, 0.2, 0, false}, scene(), kAspect, tool, at(0));
  auto m = hand.state(at(0));
  REQUIRE(m);
  CHECK(m->device == std::string("live"));
  CHECK(place(*m).isApprox(tool));
  CHECK(m->state == device_state_t::ANSWERS);
  CHECK(m->buttons == 0);

  const Vector3d target = unproject(scene(), kAspect, 0.4, 0.2, 0.5);
  const double way_s = (target - tool).norm() / Hand::kMaxSpeed_m_s;
  for (int i = 1; i <= 100; ++i) {
    const double t = 0.01 * i;
    if (i % 10 == 0) hand.aim({0.4, 0.2, 0, true}, scene(), kAspect, std::nullopt, at(t));
    m = hand.state(at(t));
    REQUIRE(m);
    // Closed form: a straight line at the speed limit, then at rest.
    REQUIRE((place(*m) - (tool + (target - tool) * std::min(1.0, t / way_s))).norm() < 1e-9);
  }
  CHECK(m->buttons == 1);
  CHECK(to_eigen(m->velocity_m_s).norm() == 0);
}

TEST_CASE("The hand keeps its speed limit for any jump of the mouse") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  Hand hand;
  double t = 0;
  std::optional<Vector3d> last;
  for (int i = 0; i < 20'000; ++i) {
    const double dt = 0.0005 + 0.01 * std::abs(unit(random));
    t += dt;
    if (random() % 3 == 0 || !last)
      hand.aim({unit(random), unit(random), unit(random), random() % 2 == 0}, scene(), kAspect, Vector3d(0.5, 0, 0), at(t));
    const auto m = hand.state(at(t));
    REQUIRE(m);
    REQUIRE(place(*m).allFinite());
    if (last) REQUIRE((place(*m) - *last).norm() <= Hand::kMaxSpeed_m_s * dt + 1e-6);
    REQUIRE(to_eigen(m->velocity_m_s).norm() <= Hand::kMaxSpeed_m_s * 1.000001);
    REQUIRE(place(*m).x() >= Hand::kMinDepth_m - 1e-9);
    REQUIRE(place(*m).x() <= Hand::kMaxDepth_m + 1e-9);
    last = place(*m);
  }
}

TEST_CASE("A silent page releases the hand, and the next grasp starts at the tool's position") {
  Hand hand;
  CHECK_FALSE(hand.state(at(0)));  // the hand is not held
  hand.aim({0, 0, 0, false}, scene(), kAspect, Vector3d(1, 0, 0), at(0));
  CHECK(hand.state(at(0.35)));
  CHECK_FALSE(hand.state(at(0.351)));
  CHECK_FALSE(hand.state(at(5)));
  hand.aim({0, 0, 0, false}, scene(), kAspect, Vector3d(2, 0.3, 0), at(6));
  const auto m = hand.state(at(6));
  REQUIRE(m);
  CHECK(place(*m).isApprox(Vector3d(2, 0.3, 0)));

  SECTION("a tool behind the camera or at no valid position gives a plane at half a metre") {
    for (const Vector3d& wrong : {Vector3d(-1, 0, 0), Vector3d(NAN, 0, 0)}) {
      Hand other;
      other.aim({0, 0, 0, false}, scene(), kAspect, wrong, at(0));
      other.state(at(0));
      std::optional<device_state_t> last;
      for (int i = 1; i < 300; ++i) {
        other.aim({0, 0, 0, false}, scene(), kAspect, wrong, at(0.01 * i));
        last = other.state(at(0.01 * i));
      }
      REQUIRE(last);
      CHECK(place(*last).isApprox(Vector3d(0.5, 0, 0)));
    }
  }
}
