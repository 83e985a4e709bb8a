// Definition of a world, from which the physics, the contact tracker and the scene message are built. The SDF loader
// creates it. Plain data, SI units, no SDF and no ODE types.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>
#include <tactus/light_def_t.hpp>
#include <tactus/look_t.hpp>
#include <tactus/map_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/pass_t.hpp>
#include <tactus/setting_t.hpp>
#include <tactus/shader_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "sync/assets/asset.h"

namespace tactus::sim {

enum class ShapeKind { kBox, kSphere, kCylinder, kCapsule, kPlane, kMesh, kHeightfield };

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  // m, shape frame, scale applied
  std::vector<Eigen::Vector3d> normals;   // unit, per vertex
  std::vector<int> indices;               // three per triangle, counter-clockwise from outside
  // Per vertex or empty, for drawing only; as in mesh_t.lcm.
  std::vector<Eigen::Vector2f> texcoords = {};
  std::vector<Eigen::Vector4f> tangents = {};
};

struct Heightfield {
  int columns = 0, rows = 0;    // samples along x and y
  Eigen::Vector3d size_m{0, 0, 0};
  Eigen::Vector3d centre_m{0, 0, 0};
  std::vector<double> heights_m;  // row-major, rows * columns, y from -size/2 upwards
};

struct ShapeDef {
  std::string name;
  int body = -1;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // in the body frame
  ShapeKind kind = ShapeKind::kBox;
  Eigen::Vector3d size_m{1, 1, 1};  // as in shape_def_t.lcm
  int mesh = -1;                    // index in WorldDef::meshes (kMesh) or ::heightfields (kHeightfield)
  int material = -1;
  // Coefficients of this surface. A pair uses the geometric mean of friction and the smaller restitution.
  double friction = 0.5;
  double restitution = 0;
};

struct BodyDef {
  std::string name;   // model::link
  bool is_static = false;
  double mass_kg = 1;
  Eigen::Vector3d centre_of_mass_m{0, 0, 0};                 // in the body frame
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // about the centre of mass, body axes
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();    // world
  Eigen::Vector3d velocity_m_s{0, 0, 0};                     // of the centre of mass at the start, world
  Eigen::Vector3d spin_rad_s{0, 0, 0};                       // at the start, world
  bool gravity = true;
  double linear_damping_1_s = 0;   // SDF velocity_decay
  double angular_damping_1_s = 0;
  int tool = -1;                   // index in WorldDef::tools for a tool, which is a ghost without collisions; -1: no tool
};

enum class JointKind { kFixed, kRevolute, kPrismatic, kUniversal, kBall };

struct JointAxis {
  Eigen::Vector3d axis{0, 0, 1};  // world, at the start
  double lower = -1e16, upper = 1e16;  // rad or m; beyond 1e15: no limit
  double damping = 0;     // N m s/rad or N s/m
  double friction = 0;    // N m or N, Coulomb
  double stiffness = 0;   // spring, N m/rad or N/m
  double reference = 0;
  double effort = -1;     // maximum torque or force of a motor; < 0: none
  double motor_velocity = 0;  // target of a tactus:motor; used when motor_effort > 0
  double motor_effort = 0;
};

struct JointDef {
  std::string name;
  JointKind kind = JointKind::kFixed;
  int parent = -1;  // body index; -1: the world
  int child = -1;
  Eigen::Vector3d anchor_m{0, 0, 0};  // world, at the start
  JointAxis axes[2];                  // continuous: a revolute without limits
};

struct VisualDef {
  ShapeDef shape;
  Eigen::Vector3d ambient{0.4, 0.4, 0.4}, diffuse{0.7, 0.7, 0.7}, specular{0.2, 0.2, 0.2}, emissive{0, 0, 0};
  double shininess = 32;
  double alpha = 1;
  int look = -1;  // index in WorldDef::looks; -1: Phong reflection without images
};

// A hole of a game: a cylinder open at the top, and the body that belongs in it.
struct HoleDef {
  std::string name;
  Eigen::Vector3d position_m{0, 0, 0};  // centre of its rim, world
  double radius_m = 0;
  double depth_m = 0.2;
  int ball = -1;
};

struct WorldDef {
  std::string name;
  Eigen::Vector3d gravity_m_s2{0, 0, -9.8};
  std::vector<BodyDef> bodies;
  std::vector<ShapeDef> shapes;
  std::vector<VisualDef> visuals;
  std::vector<JointDef> joints;
  std::vector<TriangleMesh> meshes;
  std::vector<Heightfield> heightfields;
  std::vector<material_def_t> materials;
  std::vector<sync::Asset> images;  // images that materials and looks refer to by hash, each once
  std::vector<look_t> looks;
  std::vector<shader_t> shaders;
  std::vector<pass_t> passes;
  std::vector<sync::Asset> shader_texts;  // referred to by shaders by hash, each once
  std::int64_t environment_asset = 0;     // image of the surroundings; 0: none
  std::vector<light_def_t> lights;
  std::vector<tool_def_t> tools;
  std::vector<HoleDef> holes;
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
  double camera_fov_rad = 1.05;
  Eigen::Vector3d ambient{0.1, 0.1, 0.1}, background{0.02, 0.02, 0.03};
  Eigen::Isometry3d listener = Eigen::Isometry3d::Identity();
  std::string profile;  // degradation profile, XML; empty: none
  std::vector<setting_t> settings;
  std::vector<map_def_t> maps;
  // Pairs of bodies excluded from collision: jointed without self-collision.
  std::vector<std::pair<int, int>> no_collision;
  std::string source_file;
  std::string source_text;  // the SDF text, an asset of every log
};

}  // namespace tactus::sim
