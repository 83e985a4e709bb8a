// Meshes, materials and lamps of the scenes for the measurement of frame cost.
#include "tests/bench/visual_node/picture_scenes.h"

#include <cmath>
#include <tactus/body_def_t.hpp>
#include <tactus/light_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/pose_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/vec3f_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::bench {
namespace {

constexpr std::int64_t kBall = 1, kWaves = 2;  // content hashes, made up
constexpr int kSegments = 104;                 // around a ball: 10,608 triangles

vec3f_t grey(float value) { return to_vec3f(Eigen::Vector3d::Constant(value)); }

int add_body(scene_t& scene, const Eigen::Vector3d& position) {
  body_def_t body{};
  body.id = static_cast<int>(scene.bodies.size());
  body.tool = -1;
  body.pose = to_pose(Eigen::Isometry3d(Eigen::Translation3d(position)));
  scene.bodies.push_back(body);
  return body.id;
}

visual_def_t& add_visual(scene_t& scene, int body, std::int8_t kind, const Eigen::Vector3d& size_m) {
  visual_def_t v{};
  v.look = -1;
  v.shape.body = body;
  v.shape.pose = to_pose(Eigen::Isometry3d::Identity());
  v.shape.kind = kind;
  v.shape.size_m = to_vec3(size_m);
  v.shape.material = -1;
  v.diffuse = v.ambient = grey(0.6f);
  v.specular = grey(0.3f);
  v.shininess = 32;
  v.alpha = 1;
  return scene.visuals.emplace_back(v);
}

light_def_t lamp(std::int8_t kind, const Eigen::Vector3d& at) {
  light_def_t l{};
  l.kind = kind;
  l.pose = to_pose(Eigen::Isometry3d(Eigen::Translation3d(at)));
  l.direction = to_vec3((-at).normalized());
  l.diffuse = l.specular = grey(0.8f);
  l.range_m = 20;
  l.attenuation_constant = 1;
  l.intensity = 1;
  l.inner_angle_rad = 1, l.outer_angle_rad = 1.4f, l.falloff = 1;
  l.casts_shadow = kind == light_def_t::SPOT;
  return l;
}

// From `at`, looking at the origin.
pose_t looking(const Eigen::Vector3d& at) {
  const Eigen::Vector3d x = -at.normalized(), y = Eigen::Vector3d::UnitZ().cross(x).normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, y, x.cross(y);
  pose.translation() = at;
  return to_pose(pose);
}

scene_t lit() {
  scene_t scene{};
  scene.step_ns = 1'000'000;
  scene.camera_fov_rad = 1;
  scene.ambient = grey(0.1f);
  scene.lights = {lamp(light_def_t::SPOT, {-0.3, 0.4, 1.2}), lamp(light_def_t::POINT, {-0.6, -0.7, 0.8})};
  return scene;
}

mesh_t ball() {
  const visual::Triangles t = visual::unit_sphere(kSegments);
  mesh_t mesh{};
  for (std::size_t i = 0; i < t.positions.size(); ++i)
    for (int k = 0; k < 3; ++k)
      mesh.positions_m.push_back(0.25f * t.positions[i][k]), mesh.normals.push_back(t.normals[i][k]);
  mesh.vertex_floats = static_cast<int>(mesh.positions_m.size());
  mesh.indices.assign(t.indices.begin(), t.indices.end());
  mesh.index_count = static_cast<int>(mesh.indices.size());
  return mesh;
}

HeightMap waves() {
  HeightMap map;
  map.columns = map.rows = 256, map.white = 65535;
  for (int i = 0; i < 256 * 256; ++i) {
    const double u = 2 * std::numbers::pi * (i % 256) / 256, v = 2 * std::numbers::pi * (i / 256) / 256;
    map.levels.push_back(static_cast<std::uint16_t>(65535 * (2 + std::sin(3 * u) + std::cos(2 * v)) / 4));
  }
  return map;
}

}  // namespace

PictureScene rough_balls() {
  PictureScene made{.scene = lit(), .meshes = {{kBall, ball()}}, .height_maps = {{kWaves, waves()}}};
  scene_t& scene = made.scene;
  material_def_t rough{};
  rough.bump_asset = kWaves, rough.bump_size_u_m = rough.bump_size_v_m = 0.2, rough.bump_height_m = 0.01;
  scene.materials = {rough};
  for (const double side : {-1, 1}) {
    visual_def_t& v =
        add_visual(scene, add_body(scene, {0, 0.27 * side, 0.25}), shape_def_t::MESH, Eigen::Vector3d::Zero());
    v.shape.mesh_hash = kBall, v.shape.material = 0;
    made.triangles += made.meshes.at(kBall).index_count / 3;
  }
  add_visual(scene, add_body(scene, {0, 0, 0}), shape_def_t::PLANE, {10, 10, 0}).shape.material = 0;
  scene.camera = looking({-0.9, 0, 0.75});
  return made;
}

PictureScene many_bodies(int count) {
  PictureScene made{.scene = lit(), .meshes = {}, .height_maps = {}};
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const double spacing_m = 1.2 / side;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d at{(i / side + 0.5 - 0.5 * side) * spacing_m, (i % side + 0.5 - 0.5 * side) * spacing_m,
                             0};
    const int body = add_body(made.scene, at);
    if (i % 2 == 0)
      add_visual(made.scene, body, shape_def_t::BOX, Eigen::Vector3d::Constant(0.6 * spacing_m));
    else
      add_visual(made.scene, body, shape_def_t::SPHERE, {0.35 * spacing_m, 0, 0});
  }
  made.scene.camera = looking({-0.3, 0, 1.2});
  return made;
}

}  // namespace tactus::bench
