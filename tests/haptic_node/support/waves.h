// A relief of waves, 20 mm long along x, on the plane z = 0 of a body at the origin.
#pragma once

#include <cmath>
#include <memory>
#include <tactus/material_def_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/contact/surface_maps.h"
#include "lcmtypes/vectors.h"

namespace tactus::haptic::test {

// Maps of material 0.
inline std::shared_ptr<const SurfaceMaps> waves(double height_m) {
  constexpr int kColumns = 64;
  HeightMap map{kColumns, 4, 65535, {}};
  for (int i = 0; i < kColumns * 4; ++i)
    map.levels.push_back(
        static_cast<std::uint16_t>(std::lround(65535 * (0.5 + 0.5 * std::sin(2 * M_PI * (i % kColumns + 0.5) / kColumns)))));
  material_def_t m{};
  m.bump_size_u_m = m.bump_size_v_m = 0.02, m.bump_height_m = height_m;
  auto maps = std::make_shared<SurfaceMaps>();
  maps->by_material.resize(1);
  maps->by_material[0].relief = std::make_shared<const Relief>(make_relief(map, m));
  return maps;
}

// Gives this plane, whose normal is z, the map of material 0.
inline void add_map(touch_plane_t& plane) {
  plane.material = 0;
  plane.bump_asset = 1;
  plane.point_body_m = plane.point_m;
  plane.normal_body = to_vec3f(Eigen::Vector3d::UnitZ());
  plane.bump_u = to_vec3f(Eigen::Vector3d::UnitX());
}

}  // namespace tactus::haptic::test
