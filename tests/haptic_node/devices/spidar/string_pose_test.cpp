#include "haptic_node/devices/spidar/string_pose.h"

#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <random>

#include "haptic_node/devices/spidar/spidar.h"
#include "tests/haptic_node/support/random_grip.h"

using namespace tactus::haptic;
using Eigen::Vector3d;
using test::random_pose;

namespace {

double angle(const GripPose& a, const GripPose& b) { return a.orientation.angularDistance(b.orientation); }

PerString counted(const StringFrame& f, const GripPose& pose) {
  const PerString middle = string_lengths(f, {});
  PerString l = string_lengths(f, pose);
  for (int i = 0; i < f.size(); ++i)
    l(i) = middle(i) + std::round((l(i) - middle(i)) / f.encoder_step_m) * f.encoder_step_m;
  return l;
}

}  // namespace

TEST_CASE("The structure matrix is minus the derivative of the string lengths, by finite differences") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const GripPose pose = random_pose(f, random);
    const StructureMatrix w = structure_matrix(f, pose);
    const double h = 1e-6;
    for (int k = 0; k < w.rows(); ++k) {
      const auto at = [&](double by) {
        GripPose p = pose;
        if (k < 3)
          p.position_m(k) += by;
        else
          p.orientation = Eigen::AngleAxisd(by / f.lever_m(), Vector3d::Unit(k - 3)) * p.orientation;
        return string_lengths(f, p);
      };
      // Central difference: h^2/6 times a third derivative of at most about 1/length^2, and rounding 1e-16/h.
      const PerString slope = (at(h) - at(-h)) / (2 * h);
      CHECK((slope + w.row(k).transpose()).cwiseAbs().maxCoeff() < 1e-8);
    }
  }
}

TEST_CASE("The pose is solved from exact string lengths, starting in the middle of the frame") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const GripPose truth = random_pose(f, random);
    const SolvedPose found = solve_pose(f, string_lengths(f, truth), {});
    REQUIRE(found.converged);
    CHECK(found.residual_m < 1e-9);
    CHECK((found.pose.position_m - truth.position_m).norm() < 1e-6);
    CHECK(angle(found.pose, truth) * f.lever_m() < 1e-6);
  }
}

TEST_CASE("Encoder quantisation moves the pose by at most the bound of the rounding") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(2);
  for (int trial = 0; trial < 500; ++trial) {
    const GripPose truth = random_pose(f, random);
    const SolvedPose found = solve_pose(f, counted(f, truth), truth);
    REQUIRE(found.converged);
    CHECK(found.residual_m <=
          f.encoder_step_m / 2);  // the residual of the truth, which least squares cannot exceed
    // x - x0| <= |W^+| |rounding|, with sqrt(n) half steps of rounding; lengths curve by |x|^2/(2 L), which is
    // 1e-3 of it at these steps. The search ends at a thousandth of a step.
    const Eigen::MatrixXd w = structure_matrix(f, truth);
    const double least = Eigen::JacobiSVD<Eigen::MatrixXd>(w).singularValues().minCoeff();
    const double bound = 1.01 * std::sqrt(f.size()) * f.encoder_step_m / 2 / least + 2e-3 * f.encoder_step_m;
    CHECK(std::hypot((found.pose.position_m - truth.position_m).norm(), angle(found.pose, truth) * f.lever_m()) <=
          bound);
  }
}

TEST_CASE("The pose converges in a few steps from the last tick") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const GripPose last = random_pose(f, random);
    GripPose now = last;
    now.position_m += Vector3d(0.001, 0, 0);  // 1 m/s at 1 kHz
    if (f.has_torque()) now.orientation = Eigen::AngleAxisd(0.01, Vector3d::UnitY()) * now.orientation;
    CHECK(solve_pose(f, string_lengths(f, now), last).steps <= 4);
  }
}

TEST_CASE("Inconsistent string lengths have a large residual") {
  const StringFrame f = *known_frame("desktop");
  PerString lengths = string_lengths(f, {});
  lengths(2) += 0.1;  // a slack string
  const SolvedPose found = solve_pose(f, lengths, {});
  CHECK(found.residual_m > kLostResidual_m);
  CHECK(found.pose.position_m.allFinite());
}
