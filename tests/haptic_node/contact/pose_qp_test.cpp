#include "haptic_node/contact/pose_qp.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <optional>
#include <random>

using namespace tactus::haptic;

namespace {

// Tries every set of up to six half spaces. The solution is the set whose multipliers are all >= 0 and whose pose
// all others allow (Karush, Kuhn and Tucker; the programme is convex).
std::optional<Vector6> brute_force(const std::vector<PoseHalfSpace>& region, const Vector6& goal) {
  const auto allowed = [&](const Vector6& q) {
    for (const PoseHalfSpace& h : region)
      if (h.normal.dot(q) < h.offset - 1e-9 * h.normal.norm()) return false;
    return true;
  };
  for (unsigned set = 0; set < (1u << region.size()); ++set) {
    const int count = __builtin_popcount(set);
    if (count > 6) continue;
    Eigen::MatrixXd n(6, count);
    Eigen::VectorXd d(count);
    int k = 0;
    for (std::size_t i = 0; i < region.size(); ++i)
      if (set >> i & 1) n.col(k) = region[i].normal, d[k++] = region[i].offset - region[i].normal.dot(goal);
    const Eigen::MatrixXd gram = n.transpose() * n;
    if (count > 0 && Eigen::FullPivLU<Eigen::MatrixXd>(gram).rank() < count) continue;
    const Eigen::VectorXd u = count > 0 ? Eigen::VectorXd(gram.fullPivLu().solve(d)) : d;
    if (count > 0 && u.minCoeff() < -1e-12) continue;
    const Vector6 q = goal + n * u;
    if (allowed(q)) return q;
  }
  return std::nullopt;
}

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}

// A contact of a tool: a direction, and its place on the tool in levers.
PoseHalfSpace contact(std::mt19937& random) {
  std::normal_distribution<> g;
  const Eigen::Vector3d n = Eigen::Vector3d(g(random), g(random), g(random)).normalized();
  const Eigen::Vector3d arm(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2));
  PoseHalfSpace h;
  h.normal << n, arm.cross(n);
  h.offset = uniform(random, -0.02, 0.01);
  return h;
}

}  // namespace

TEST_CASE("The closest pose equals the best pose over all binding sets") {
  std::mt19937 random(11);
  int feasible = 0, max_binding = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<PoseHalfSpace> region(1 + random() % 11);
    for (PoseHalfSpace& h : region) h = contact(random);
    Vector6 goal;
    for (int k = 0; k < 6; ++k) goal[k] = uniform(random, -0.03, 0.03);
    const auto expected = brute_force(region, goal);
    const ClosestPose found = closest_pose(region, goal);
    CAPTURE(trial, region.size());
    if (!expected) {
      CHECK_FALSE(found.feasible);
      continue;
    }
    ++feasible;
    REQUIRE(found.feasible);
    CHECK((found.pose - *expected).norm() < 1e-7 * (1 + (*expected - goal).norm()));
    // The multipliers give the difference to the goal exactly, so the contacts share the wrench completely.
    Vector6 sum = goal;
    int binding = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
      CHECK(found.multiplier[i] >= 0);
      sum += found.multiplier[i] * region[i].normal;
      binding += found.multiplier[i] > 0;
    }
    CHECK((sum - found.pose).norm() < 1e-12);
    max_binding = std::max(max_binding, binding);
  }
  CHECK(feasible > 1000);
  CHECK(max_binding >= 5);
}

TEST_CASE("Three of four corners carry a flat box") {
  // Four corners over a floor: the fourth depends on three.
  std::vector<PoseHalfSpace> region(4);
  const double x[] = {1, 1, -1, -1}, y[] = {1, -1, 1, -1};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d arm(x[i], y[i], -0.5), up(0, 0, 1);
    region[static_cast<std::size_t>(i)].normal << up, arm.cross(up);
  }
  Vector6 goal = Vector6::Zero();
  goal[2] = -0.003;
  const ClosestPose flat = closest_pose(region, goal);
  CHECK(flat.feasible);
  CHECK(flat.pose.norm() < 1e-12);
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += flat.multiplier[static_cast<std::size_t>(i)];
  CHECK(sum == Approx(0.003));
}

TEST_CASE("Half spaces without a common pose yield a compromise and feasible is false") {
  std::vector<PoseHalfSpace> region(2);
  region[0].normal << 0, 0, 1, 0, 0, 0;
  region[1].normal << 0, 0, -1, 0, 0, 0;
  region[0].offset = 0.001;
  region[1].offset = 0.001;
  const ClosestPose between = closest_pose(region, Vector6::Constant(0.01));
  CHECK_FALSE(between.feasible);
  CHECK(std::abs(between.pose[2]) < 2e-4);
  CHECK(between.pose[0] == Approx(0.01));
}

TEST_CASE("The shares of a motion into all binding half spaces give each its own rate") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    BindingSet set;
    std::vector<Vector6> normals;
    const std::size_t count = 1 + random() % 6;
    for (std::size_t i = 0; i < count; ++i) {
      normals.push_back(contact(random).normal);
      REQUIRE(set.add(i, normals.back()));
    }
    if (count > 2) {
      set.drop(1);
      normals.erase(normals.begin() + 1);
    }
    std::array<double, 6> rates{};
    for (std::size_t k = 0; k < normals.size(); ++k) rates[k] = uniform(random, -1, 1);
    const auto shares = set.shares(rates);
    Vector6 motion = Vector6::Zero();
    for (std::size_t k = 0; k < normals.size(); ++k) motion += shares[k] * normals[k];
    for (std::size_t k = 0; k < normals.size(); ++k)
      CHECK(motion.dot(normals[k]) == Approx(rates[k]).margin(1e-9));
    CHECK_FALSE(set.add(9, motion));
    CHECK(set.free_part(motion).norm() < 1e-9);
  }
}
