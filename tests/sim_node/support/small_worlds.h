// Small worlds, built in code, for the tests of the simulation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim::test {

inline constexpr double kG = 9.81;
inline constexpr double kStep = 0.001;

inline WorldDef empty_world(double g = kG) {
  WorldDef w;
  w.name = "test";
  w.gravity_m_s2 = {0, 0, -g};
  return w;
}

inline int add_body(WorldDef& w, const std::string& name, double mass_kg, const Eigen::Matrix3d& inertia,
                    const Eigen::Isometry3d& pose) {
  BodyDef b;
  b.name = name;
  b.is_static = mass_kg <= 0;
  b.mass_kg = mass_kg;
  b.inertia_kg_m2 = inertia;
  b.pose = pose;
  w.bodies.push_back(b);
  return static_cast<int>(w.bodies.size()) - 1;
}

inline int add_shape(WorldDef& w, int body, ShapeKind kind, const Eigen::Vector3d& size, double friction = 0.5,
                     double restitution = 0) {
  ShapeDef s;
  s.name = w.bodies[static_cast<std::size_t>(body)].name + "_shape";
  s.body = body;
  s.kind = kind;
  s.size_m = size;
  s.friction = friction;
  s.restitution = restitution;
  w.shapes.push_back(s);
  return static_cast<int>(w.shapes.size()) - 1;
}

inline Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

inline int add_floor(WorldDef& w, double friction = 0.5, double restitution = 0) {
  const int body = add_body(w, "floor", 0, Eigen::Matrix3d::Identity(), at(0, 0, 0));
  add_shape(w, body, ShapeKind::kPlane, {10, 10, 1}, friction, restitution);
  return body;
}

inline Eigen::Matrix3d ball_inertia(double mass, double r) { return 0.4 * mass * r * r * Eigen::Matrix3d::Identity(); }

inline Eigen::Matrix3d box_inertia(double mass, const Eigen::Vector3d& s) {
  const Eigen::Vector3d q = s.cwiseAbs2();
  return (mass / 12 * Eigen::Vector3d(q.y() + q.z(), q.x() + q.z(), q.x() + q.y())).asDiagonal();
}

inline int add_ball(WorldDef& w, double mass, double r, const Eigen::Vector3d& place, double friction = 0.5,
                    double restitution = 0) {
  const int body = add_body(w, "ball", mass, ball_inertia(mass, r), at(place.x(), place.y(), place.z()));
  add_shape(w, body, ShapeKind::kSphere, {r, 0, 0}, friction, restitution);
  return body;
}

inline int add_box(WorldDef& w, double mass, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose,
                   double friction = 0.5, double restitution = 0) {
  const int body = add_body(w, "box", mass, box_inertia(mass, size), pose);
  add_shape(w, body, ShapeKind::kBox, size, friction, restitution);
  return body;
}

inline JointDef& add_joint(WorldDef& w, JointKind kind, int parent, int child, const Eigen::Vector3d& anchor,
                           const Eigen::Vector3d& axis, const Eigen::Vector3d& axis2 = {0, 1, 0}) {
  JointDef j;
  j.name = "joint";
  j.kind = kind;
  j.parent = parent;
  j.child = child;
  j.anchor_m = anchor;
  j.axes[0].axis = axis;
  j.axes[1].axis = axis2;
  w.joints.push_back(j);
  return w.joints.back();
}

// n links of a chain that hangs from the world at (0, 0, top), straight down, with universal joints.
inline WorldDef chain_world(int n, double length = 0.1, double mass = 0.05, double top = 2) {
  WorldDef w = empty_world();
  const double r = 0.1 * length;
  const double across = mass * (3 * r * r + length * length) / 12;
  for (int i = 0; i < n; ++i) {
    const double z = top - (i + 0.5) * length;
    Eigen::Matrix3d inertia = Eigen::Vector3d(across, across, 0.5 * mass * r * r).asDiagonal();
    add_body(w, "link", mass, inertia, at(0, 0, z));
    add_shape(w, i, ShapeKind::kCapsule, {r, 0, 0.8 * length});
    add_joint(w, JointKind::kUniversal, i - 1, i, {0, 0, top - i * length}, {1, 0, 0}, {0, 1, 0});
    if (i > 0) w.no_collision.emplace_back(i - 1, i);
  }
  return w;
}

// Largest distance between the two images of an anchor, m: the error of the joints that turn.
inline double largest_joint_gap_m(const WorldDef& w, std::span<const BodyMotion> bodies) {
  double largest = 0;
  for (const JointDef& j : w.joints) {
    if (j.kind == JointKind::kPrismatic || j.kind == JointKind::kFixed) continue;
    const auto now = [&](int body) -> Eigen::Vector3d {
      if (body < 0) return j.anchor_m;
      const auto b = static_cast<std::size_t>(body);
      return bodies[b].position_m + bodies[b].orientation * (w.bodies[b].pose.inverse() * j.anchor_m);
    };
    largest = std::max(largest, (now(j.parent) - now(j.child)).norm());
  }
  return largest;
}

}  // namespace tactus::sim::test
