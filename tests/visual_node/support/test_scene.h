// Small scenes for the tests of this folder.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <tactus/body_def_t.hpp>
#include <tactus/light_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/pose_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/vec3f_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "lcmtypes/height_map.h"
#include "lcmtypes/vectors.h"

namespace tactus::test {

inline vec3f_t grey(float value) { return to_vec3f(Eigen::Vector3d::Constant(value)); }

inline pose_t at(double x, double y, double z) {
  return to_pose(Eigen::Isometry3d(Eigen::Translation3d(x, y, z)));
}

// An empty scene; a camera at the origin that looks along +x.
inline scene_t empty_scene() {
  scene_t scene{};
  scene.step_ns = 1'000'000;
  scene.camera = at(0, 0, 0);
  scene.listener = at(0, 0, 0);
  scene.camera_fov_rad = 1;
  return scene;
}

inline int add_body(scene_t& scene, const Eigen::Vector3d& position) {
  body_def_t body{};
  body.id = static_cast<int>(scene.bodies.size());
  body.tool = -1;
  body.pose = at(position.x(), position.y(), position.z());
  scene.bodies.push_back(body);
  return body.id;
}

inline void add_visual(scene_t& scene, int body, int kind, const Eigen::Vector3d& size) {
  visual_def_t v{};
  v.look = -1;
  v.shape.body = body;
  v.shape.pose = at(0, 0, 0);
  v.shape.kind = static_cast<std::int8_t>(kind);
  v.shape.size_m = to_vec3(size);
  v.shape.material = -1;
  v.diffuse = v.ambient = grey(0.5f);
  v.specular = v.emissive = grey(0);
  v.shininess = 16;
  v.alpha = 1;
  scene.visuals.push_back(v);
}

inline void add_tool(scene_t& scene, double radius_m) {
  tool_def_t tool{};
  tool.body = add_body(scene, Eigen::Vector3d::Zero());
  tool.radius_m = radius_m;
  tool.mass_kg = 0.1;
  tool.material = -1;
  scene.bodies.back().tool = static_cast<int>(scene.tools.size());
  scene.tools.push_back(tool);
}

// Waves along u: heights (1 + sin(2 pi u)) / 2 at the middle of each pixel.
inline HeightMap sine_map(int columns, int rows) {
  HeightMap map;
  map.columns = columns, map.rows = rows, map.white = 65535;
  for (int i = 0; i < columns * rows; ++i) {
    const double u = (i % columns + 0.5) / columns;
    map.levels.push_back(
        static_cast<std::uint16_t>(std::lround(65535 * (1 + std::sin(2 * std::numbers::pi * u)) / 2)));
  }
  return map;
}

inline material_def_t rough(std::int64_t asset, double size_u_m, double size_v_m, double height_m) {
  material_def_t m{};
  m.name = "rough" + std::to_string(asset);
  m.youngs_modulus_Pa = 1e10;
  m.bump_asset = asset, m.bump_size_u_m = size_u_m, m.bump_size_v_m = size_v_m, m.bump_height_m = height_m;
  return m;
}

// A spot that shines straight down, white, without attenuation; full angles of the cone.
inline light_def_t spot(const Eigen::Vector3d& position, double inner_rad, double outer_rad) {
  light_def_t lamp{};
  lamp.kind = light_def_t::SPOT;
  lamp.pose = at(position.x(), position.y(), position.z());
  lamp.direction = to_vec3({0, 0, -1});
  lamp.diffuse = grey(1);
  lamp.specular = grey(0);
  lamp.range_m = 20;
  lamp.attenuation_constant = 1;
  lamp.intensity = 1;
  lamp.inner_angle_rad = static_cast<float>(inner_rad);
  lamp.outer_angle_rad = static_cast<float>(outer_rad);
  lamp.falloff = 1;
  lamp.casts_shadow = 1;
  return lamp;
}

}  // namespace tactus::test
