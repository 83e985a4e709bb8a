#include "visual_node/lens/camera.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace tactus::visual;

namespace {
Eigen::Vector3f ndc(const Camera& c, const Eigen::Vector3f& p) {
  const Eigen::Vector4f clip = c.clip_from_world() * p.homogeneous();
  return clip.head<3>() / clip.w();
}
// Float has 24 bits; the chain of two products loses some of them.
constexpr float kRounding = 1e-5f;
}  // namespace

TEST_CASE("An SDF camera looks along its x axis with z up and y to the left") {
  const Camera c = make_camera(Eigen::Isometry3d::Identity(), std::numbers::pi / 2, 640, 480, 0.1, 100);
  CHECK(ndc(c, {5, 0, 0}).head<2>().norm() < kRounding);
  CHECK(ndc(c, {5, 1, 0}).x() < 0);
  CHECK(ndc(c, {5, 0, 1}).y() > 0);

  SECTION("the horizontal field of view spans the picture, and pixels are square") {
    CHECK(ndc(c, {5, -5, 0}).x() == Approx(1));
    CHECK(ndc(c, {5, 0, 3.75f}).y() == Approx(1));  // 5 tan(45 deg) * 480 / 640
    CHECK(c.focal_px == Approx(320));
  }
  SECTION("near and far are the ends of the depth range") {
    CHECK(ndc(c, {0.1f, 0, 0}).z() == Approx(-1));
    CHECK(ndc(c, {100, 0, 0}).z() == Approx(1));
  }
}

TEST_CASE("A camera at any pose sees the inverse motion of the world") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d pose =
        Eigen::Translation3d(u(random), u(random), u(random)) * Eigen::Quaterniond::UnitRandom();
    const Eigen::Vector3d in_camera(2 + u(random), u(random), u(random));
    const Camera here = make_camera(pose, 1, 640, 480, 0.1, 100),
                 origin = make_camera(Eigen::Isometry3d::Identity(), 1, 640, 480, 0.1, 100);
    const Eigen::Vector3f world = (pose * in_camera).cast<float>();
    CHECK((ndc(here, world) - ndc(origin, in_camera.cast<float>())).norm() < 100 * kRounding);
  }
}

TEST_CASE("The view of a lamp is centred on its axis for every direction") {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(1, 2, -3)}) {
    const Eigen::Vector3d lamp(1, 2, 3);
    const Eigen::Vector4f eye =
        look_along(lamp, direction) * (lamp + 2 * direction.normalized()).cast<float>().homogeneous();
    CHECK((eye.head<3>() - Eigen::Vector3f(0, 0, -2)).norm() < kRounding);
  }
}

TEST_CASE("A camera 300 km from the origin sees as exactly as one at the origin") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d away = 3e5 * Eigen::Vector3d(u(random), u(random), u(random));
    const Eigen::Isometry3d pose = Eigen::Translation3d(away) * Eigen::Quaterniond::UnitRandom();
    const Camera c = make_camera(pose, 1, 640, 480, 0.1, 100), origin = make_camera(Eigen::Isometry3d::Identity(), 1, 640, 480, 0.1, 100);
    CHECK(c.eye.cwiseAbs().maxCoeff() <= 32);
    const Eigen::Vector3d in_camera(2 + u(random), u(random), u(random));
    // A place has a step of 4 um about the origin of the picture, which is 2e-6 of the distance of at least 1 m.
    CHECK((ndc(c, c.about_origin(pose * in_camera)) - ndc(origin, in_camera.cast<float>())).norm() < 2e-4f);
  }
  CHECK(drawing_origin({31, -31, 31.9}).isZero(0));
  CHECK(drawing_origin({33, 0, -100}) == Eigen::Vector3d(64, 0, -128));
  CHECK(drawing_origin(Eigen::Vector3d::Constant(std::nan(""))).isZero(0));
}
