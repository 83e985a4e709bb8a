// Scenes that are difficult for penetration avoidance: fast, thin, spinning, stacked and notched bodies.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/small_worlds.h"

namespace tactus::sim::test {

struct HardScene {
  std::string name;
  WorldDef world;
  double seconds = 1;
  // Bodies must stay above this height, which is below every floor and wall of the scene. A lower body has passed
  // through.
  double floor_m = -0.01;
};

inline BodyDef& body_of(WorldDef& w, int i) { return w.bodies[static_cast<std::size_t>(i)]; }

inline int add_mesh(WorldDef& w, const Soup& s) {
  w.meshes.push_back(
      {s.vertices, std::vector<Eigen::Vector3d>(s.vertices.size(), Eigen::Vector3d::UnitZ()), s.indices});
  return static_cast<int>(w.meshes.size()) - 1;
}
inline int add_mesh_body(WorldDef& w, int mesh, double mass, double r, const Eigen::Isometry3d& pose,
                         double restitution) {
  const int body = add_body(w, "lump", mass, ball_inertia(mass, r), pose);
  w.shapes[static_cast<std::size_t>(add_shape(w, body, ShapeKind::kMesh, {1, 1, 1}, 0.5, restitution))].mesh =
      mesh;
  return body;
}

// A horizontal wall of 1 mm, and a floor 20 mm below, which must stay untouched.
inline WorldDef thin_wall(double restitution) {
  WorldDef w = empty_world();
  add_box(w, 0, {1, 1, 0.001}, at(0, 0, 0), 0.4, restitution);
  return w;
}

inline HardScene shot_at_wall(double restitution, bool edge_first) {
  HardScene s{edge_first ? "boxes 20 m/s on 1 mm wall" : "balls 20 m/s on 1 mm wall", thin_wall(restitution), 0.25,
              -0.0005};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 9; ++i) {
    const Eigen::Vector3d place(0.25 * (i % 3 - 1), 0.25 * (i / 3 - 1), 0.3 + 0.037 * i);
    const Eigen::Isometry3d pose =
        at(place.x(), place.y(), place.z()) *
        Eigen::AngleAxisd(M_PI * u(random), Eigen::Vector3d(u(random), u(random), u(random)).normalized());
    const int body = edge_first ? add_box(s.world, 0.2, {0.06, 0.04, 0.02}, pose, 0.4, restitution)
                                : add_ball(s.world, 0.1, 0.01 + 0.002 * i, place, 0.4, restitution);
    body_of(s.world, body).velocity_m_s = {0.5 * u(random), 0.5 * u(random), -20};
  }
  return s;
}

// Driven rods hinged in the middle above a floor that they hit with their ends, and free ones thrown down.
inline HardScene rods() {
  HardScene s{"rods that fall and spin", empty_world(), 1.0, -0.01};
  add_floor(s.world, 0.5, 0.3);
  add_box(s.world, 0, {0.3, 0.3, 0.001}, at(0, 0, 0.15), 0.5, 0.3);
  for (int i = 0; i < 6; ++i) {
    const double mass = 0.1, length = 0.2, r = 0.005;
    const Eigen::Matrix3d inertia =
        Eigen::Vector3d(mass * length * length / 12, mass * length * length / 12, mass * r * r / 2).asDiagonal();
    const int body = add_body(s.world, "rod", mass, inertia,
                              at(0.12 * (i - 2.5), 0.02 * i, 0.4 + 0.05 * i) *
                                  Eigen::AngleAxisd(0.5 + 0.4 * i, Eigen::Vector3d(1, 0.3 * i, 0.2).normalized()));
    add_shape(s.world, body, i % 2 ? ShapeKind::kCapsule : ShapeKind::kCylinder, {r, 0, length}, 0.5, 0.3);
    body_of(s.world, body).velocity_m_s = {0, 0, -5.0 - i};
  }
  return s;
}

inline HardScene lumps(double speed) {
  HardScene s{"lumpy meshes dropped on each other", empty_world(), 0.8, -0.01};
  add_floor(s.world, 0.5, 0.2);
  for (int i = 0; i < 3; ++i) {
    const int mesh = add_mesh(s.world, lumpy_sphere(2, 0.04, static_cast<std::uint64_t>(i + 1)));
    const int body = add_mesh_body(s.world, mesh, 0.3, 0.04, at(0.01 * i, 0.008 * i, 0.07 + 0.12 * i), 0.2);
    body_of(s.world, body).velocity_m_s = {0, 0, -speed};
  }
  return s;
}

inline HardScene heap(int n) {
  HardScene s{"heap of " + std::to_string(n), empty_world(), 1.5, -0.01};
  add_floor(s.world, 0.5, 0.1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < n; ++i) {
    // Four per layer, without initial overlap: the longest is 0.11 m.
    const Eigen::Isometry3d pose =
        at(0.12 * (i % 2) + 0.003 * u(random), 0.12 * (i / 2 % 2) + 0.003 * u(random), 0.1 + 0.12 * (i / 4)) *
        Eigen::AngleAxisd(3 * u(random), Eigen::Vector3d(u(random), u(random), u(random)).normalized());
    if (i % 3 == 0) add_ball(s.world, 0.1, 0.03, pose.translation(), 0.4, 0.1);
    if (i % 3 == 1) add_box(s.world, 0.2, {0.06, 0.08, 0.04}, pose, 0.4, 0.1);
    if (i % 3 == 2) {
      const int body = add_body(s.world, "rod", 0.15, box_inertia(0.15, {0.03, 0.03, 0.1}), pose);
      add_shape(s.world, body, ShapeKind::kCapsule, {0.02, 0, 0.06}, 0.4, 0.1);
    }
  }
  return s;
}

inline HardScene cradle(double apart) {
  HardScene s{apart > 0 ? "row of balls, apart" : "row of balls, touching", empty_world(0), 0.5, -1};
  for (int i = 0; i < 5; ++i) {
    const int ball = add_ball(s.world, 0.1, 0.02, {(0.04 + apart) * i - (i == 0 ? 0.02 : 0), 0, 0}, 0.5, 1);
    if (i == 0) body_of(s.world, ball).velocity_m_s = {3, 0, 0};
  }
  return s;
}

// A chain released beside a post, with a loose ball in its path.
inline HardScene chain_and_post() {
  HardScene s{"chain that swings into things", chain_world(8, 0.08, 0.03, 1), 1.5, -0.01};
  const Eigen::Isometry3d lie = at(0, 0, 1) * Eigen::AngleAxisd(-1.2, Eigen::Vector3d::UnitY()) * at(0, 0, -1);
  for (BodyDef& b : s.world.bodies) b.pose = lie * b.pose;
  for (JointDef& j : s.world.joints) {
    j.anchor_m = lie * j.anchor_m;
    for (JointAxis& a : j.axes) a.axis = lie.linear() * a.axis;
  }
  add_box(s.world, 0, {0.02, 0.5, 0.6}, at(-0.1, 0, 0.5), 0.4, 0.3);
  add_ball(s.world, 0.05, 0.03, {0.1, 0.001, 0.33}, 0.4, 0.3);
  add_floor(s.world);
  return s;
}

inline std::vector<HardScene> hard_scenes() {
  return {shot_at_wall(0, false),
          shot_at_wall(0.5, false),
          shot_at_wall(0, true),
          shot_at_wall(0.4, true),
          rods(),
          lumps(0),
          lumps(5),
          heap(60),
          cradle(0),
          cradle(1e-4),
          chain_and_post()};
}

}  // namespace tactus::sim::test
