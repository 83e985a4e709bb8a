// The proxy of a rigid tool against closed forms, and against its own principle: no allowed pose near it has less
// energy.
#include "haptic_node/contact/rigid_proxy.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "haptic_node/rendering/rigid_coupling.h"
#include "haptic_node/contact/rotation_math.h"

using namespace tactus::haptic;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kLever_m = 0.05, kStiffness = 1000, kTick_s = 0.001;

// A plane that limits one point of the tool.
struct Wall {
  Vector3d normal, point, tool_point;
  double friction = 0;
  Vector3d velocity = Vector3d::Zero();
};

struct World {
  std::vector<Wall> walls;
  std::vector<Surface> surfaces{};
  RigidProxy proxy{kLever_m, 0.05, 0};

  void tick(const DevicePose& device, double may_move_m = 1) {
    surfaces.resize(walls.size());
    for (std::size_t i = 0; i < walls.size(); ++i) {
      Surface& s = surfaces[i];
      walls[i].point += kTick_s * walls[i].velocity;
      s.normal = walls[i].normal;
      s.point = walls[i].point;
      s.velocity = walls[i].velocity;
      s.tool_point = walls[i].tool_point;
      s.offset_m = s.normal.dot(s.point - proxy.orientation() * s.tool_point);
      s.friction_static = s.friction_dynamic = walls[i].friction;
      s.coupling_stiffness_N_m = kStiffness;
    }
    proxy.step(surfaces, device, kTick_s, may_move_m);
  }
  Wrench wrench(const DevicePose& device) {
    DeviceState at;
    at.position = device.position;
    at.orientation = device.orientation;
    std::vector<Vector3d> forces(surfaces.size());
    rigid_forces(surfaces, proxy, at, 1, forces);
    Wrench w;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      w.force_N += forces[i];
      w.torque_N_m += proxy.arm(surfaces[i]).cross(forces[i]);
    }
    return w;
  }
  double worst_gap() const {
    double gap = 1;
    for (const Wall& w : walls)
      gap = std::min(gap, w.normal.dot(proxy.position() + proxy.orientation() * w.tool_point - w.point));
    return gap;
  }
};

// A box of half edges `half` over the floor z = 0, by its lower corners.
World box_on_floor(const Vector3d& half, double friction = 0) {
  World w;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      w.walls.push_back({Vector3d::UnitZ(), Vector3d::Zero(), {x * half.x(), y * half.y(), -half.z()}, friction});
  w.proxy.reset({{0, 0, half.z() + 0.001}, Quaterniond::Identity()});
  return w;
}

double energy(const DevicePose& at, const DevicePose& device) {
  return (at.position - device.position).squaredNorm() +
         kLever_m * kLever_m * rotation_between(at.orientation, device.orientation).squaredNorm();
}

Quaterniond about(const Vector3d& axis, double rad) { return Quaterniond(Eigen::AngleAxisd(rad, axis)); }

}  // namespace

TEST_CASE("A box pressed flat on a floor has the force of the spring, and its torque until it tips") {
  const Vector3d half(0.02, 0.03, 0.01);
  World w = box_on_floor(half);
  const double depth = 0.003;
  // The torque of the rotational spring, lever^2 k phi, tips the box when it exceeds the force times half an edge.
  const double tips = depth * half.x() / (kLever_m * kLever_m);
  for (const double part : {0.0, 0.3, 0.9}) {
    const DevicePose device{{0, 0, half.z() - depth}, about(Vector3d::UnitY(), part * tips)};
    for (int i = 0; i < 5; ++i) w.tick(device);
    const Wrench felt = w.wrench(device);
    CHECK(w.proxy.position().z() == Approx(half.z()).margin(1e-8));
    CHECK(rotation_between(w.proxy.orientation(), Quaterniond::Identity()).norm() < 1e-7);
    CHECK(felt.force_N.z() == Approx(kStiffness * depth).epsilon(1e-6));
    CHECK(felt.torque_N_m.y() == Approx(-kStiffness * kLever_m * kLever_m * part * tips).margin(1e-8));
    CHECK(felt.torque_N_m.x() == Approx(0).margin(1e-8));
  }
  const DevicePose far{{0, 0, half.z() - depth}, about(Vector3d::UnitY(), 2 * tips)};
  for (int i = 0; i < 20; ++i) w.tick(far);
  CHECK(rotation_between(w.proxy.orientation(), Quaterniond::Identity()).norm() > 0.01);  // it has tipped
  CHECK(w.worst_gap() > -1e-8);
  // On an edge the wrench is that of one force at the edge: torque over force is its distance.
  const Wrench felt = w.wrench(far);
  const Vector3d edge = w.proxy.orientation() * Vector3d(half.x(), 0, -half.z());
  CHECK((felt.torque_N_m - edge.cross(felt.force_N)).norm() < 1e-6);
}

TEST_CASE("No allowed pose near the proxy has less coupling energy") {
  std::mt19937 random(5);
  std::normal_distribution<> g;
  const auto vector = [&](double size) { return Vector3d(size * g(random), size * g(random), size * g(random)); };
  int pressed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    World w;
    w.proxy.reset({Vector3d::Zero(), Quaterniond::Identity()});
    for (int i = 0; i < 3 + trial % 8; ++i) {
      const Vector3d n = vector(1).normalized(), p = vector(0.02);
      w.walls.push_back({n, p - std::abs(0.002 * g(random)) * n, p});
    }
    const DevicePose device{vector(0.005), rotated_by(vector(0.1), Quaterniond::Identity())};
    for (int i = 0; i < 10; ++i) w.tick(device);
    REQUIRE(w.proxy.feasible());
    CHECK(w.worst_gap() > -1e-7);
    const DevicePose found{w.proxy.position(), w.proxy.orientation()};
    const double least = energy(found, device);
    pressed += least > 1e-12;
    for (int k = 0; k < 400; ++k) {
      const double size = std::pow(10, -2 - 3.0 * (k % 4) / 3);
      DevicePose other{found.position + vector(size * kLever_m), rotated_by(vector(size), found.orientation)};
      bool allowed = true;
      for (const Wall& wall : w.walls)
        allowed =
            allowed && wall.normal.dot(other.position + other.orientation * wall.tool_point - wall.point) >= 0;
      if (allowed) CHECK(energy(other, device) > least - 1e-9);
    }
  }
  CHECK(pressed > 100);
}

TEST_CASE("A pressed box holds in translation and rotation up to the friction limit and does not creep") {
  const Vector3d half(0.02, 0.02, 0.01);
  const double mu = 0.5, depth = 0.004;
  World w = box_on_floor(half, mu);
  DevicePose device{{0, 0, half.z() - depth}, Quaterniond::Identity()};
  for (int i = 0; i < 10; ++i) w.tick(device);
  SECTION("The box holds in translation") {
    device.position.x() = 0.8 * mu * depth;
    w.tick(device);
    const Vector3d first = w.proxy.position();
    for (int i = 0; i < 2000; ++i) w.tick(device);
    CHECK((w.proxy.position() - first).norm() < 1e-6);
    CHECK(std::abs(w.proxy.position().x()) < 2e-5);
    CHECK(w.wrench(device).force_N.x() == Approx(-kStiffness * 0.8 * mu * depth).epsilon(0.02));
  }
  SECTION("Beyond the friction cone the box slides with the force of the cone") {
    for (int i = 0; i < 400; ++i) {
      device.position.x() += 1e-4;
      w.tick(device);
    }
    const Wrench felt = w.wrench(device);
    CHECK(w.proxy.position().x() > 0.03);
    CHECK(felt.force_N.x() == Approx(-mu * felt.force_N.z()).epsilon(0.01));
    CHECK(felt.force_N.z() == Approx(kStiffness * depth).epsilon(0.01));
  }
  SECTION("The box holds in rotation") {
    // Four corners at a distance r hold a twist up to about mu F r.
    const double most = mu * depth * half.head<2>().norm() / (kLever_m * kLever_m);
    device.orientation = about(Vector3d::UnitZ(), 0.6 * most);
    w.tick(device);
    const Quaterniond first = w.proxy.orientation();
    for (int i = 0; i < 2000; ++i) w.tick(device);
    CHECK(rotation_between(first, w.proxy.orientation()).norm() < 1e-4);
    CHECK(w.wrench(device).torque_N_m.z() == Approx(-kStiffness * kLever_m * kLever_m * 0.6 * most).epsilon(0.05));
    device.orientation = about(Vector3d::UnitZ(), 3 * most);
    for (int i = 0; i < 2000; ++i) w.tick(device);
    CHECK(rotation_between(first, w.proxy.orientation()).norm() > most);  // slipped
    CHECK(std::abs(w.wrench(device).torque_N_m.z()) <
          1.01 * mu * w.wrench(device).force_N.z() * half.head<2>().norm());
  }
}

TEST_CASE("A belt carries a pressed box at its speed until the spring stops it") {
  World w = box_on_floor({0.02, 0.02, 0.01}, 0.6);
  for (Wall& wall : w.walls) wall.velocity = {0.1, 0, 0};
  const DevicePose device{{0, 0, 0.006}, Quaterniond::Identity()};
  for (int i = 0; i < 10; ++i) w.tick(device);
  const double early = w.proxy.velocity().x();
  for (int i = 0; i < 200; ++i) w.tick(device);
  const Wrench felt = w.wrench(device);
  CHECK(early == Approx(0.1).epsilon(0.02));
  CHECK(std::abs(w.proxy.velocity().x()) < 1e-3);
  CHECK(felt.force_N.x() == Approx(0.6 * felt.force_N.z()).epsilon(0.01));
}

TEST_CASE("No point of the tool moves further in a tick than the allowed distance") {
  World w;
  w.proxy.reset({Vector3d::Zero(), Quaterniond::Identity()});
  w.tick({{1, 0, 0}, about(Vector3d::UnitX(), 3)}, 0.004);
  CHECK(w.proxy.position().norm() +
            0.05 * rotation_between(w.proxy.orientation(), Quaterniond::Identity()).norm() <=
        0.0041);
  CHECK(w.proxy.moved_m() > 0.003);
}

TEST_CASE("Between walls without room the force does not exceed that of the depth") {
  World w;
  w.walls = {{Vector3d::UnitZ(), {0, 0, 0.001}, Vector3d::Zero()},
             {-Vector3d::UnitZ(), {0, 0, -0.001}, Vector3d::Zero()}};
  w.proxy.reset({Vector3d::Zero(), Quaterniond::Identity()});
  const DevicePose device{{0, 0, 0.0005}, Quaterniond::Identity()};
  for (int i = 0; i < 10; ++i) w.tick(device);
  CHECK_FALSE(w.proxy.feasible());
  CHECK(w.wrench(device).force_N.norm() < kStiffness * 0.002);
}

TEST_CASE("Forces are adjusted to a wanted wrench as far as the contact points allow") {
  std::mt19937 random(8);
  std::normal_distribution<> g;
  const auto vector = [&](double size) { return Vector3d(size * g(random), size * g(random), size * g(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t count = 1 + random() % 5;
    std::vector<Vector3d> arms(count), forces(count);
    for (std::size_t i = 0; i < count; ++i) arms[i] = vector(0.03), forces[i] = vector(1);
    const Wrench felt{vector(1), vector(0.02)};
    share_wrench(felt, arms, forces, std::numeric_limits<double>::infinity());
    Wrench sum;
    for (std::size_t i = 0; i < count; ++i) {
      sum.force_N += forces[i];
      sum.torque_N_m += arms[i].cross(forces[i]);
    }
    CHECK((sum.force_N - felt.force_N).norm() < 1e-9);
    if (count >= 3) CHECK((sum.torque_N_m - felt.torque_N_m).norm() < 1e-6);
    if (count == 2) {  // no torque is possible about the line through both
      const Vector3d line = (arms[1] - arms[0]).normalized();
      const Vector3d error = sum.torque_N_m - felt.torque_N_m;
      CHECK((error - error.dot(line) * line).norm() < 1e-6);
    }
  }
}

TEST_CASE("A torque about nearly collinear contact points does not cause large forces") {
  const std::vector<Vector3d> arms{{-0.02, 0, -0.01}, {0, 0.0001, -0.01}, {0.02, 0, -0.01}};
  std::vector<Vector3d> forces(3, Vector3d(0, 0, 1));
  const Wrench felt{{0, 0, 3}, {0.01, 0, 0}};
  share_wrench(felt, arms, forces, 8);
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& f : forces) {
    sum += f;
    CHECK(f.norm() <= 8 + 1.01);
  }
  CHECK((sum - felt.force_N).norm() < 1e-9);
}
