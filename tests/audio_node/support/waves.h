// A surface of waves along u, for sliding contacts.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <tactus/material_def_t.hpp>

#include "audio_node/excitation/audio_surfaces.h"
#include "sync/time/time.h"

namespace tactus::audio::test {

inline constexpr double kWave_m = 0.002, kHigh_m = 0.0002;

inline HeightMap waves() {
  HeightMap map{32, 2, 65535, {}};
  for (int i = 0; i < 64; ++i)
    map.levels.push_back(static_cast<std::uint16_t>(
        std::lround(65535 * (0.5 + 0.5 * std::sin(2 * std::numbers::pi * (i % 32 + 0.5) / 32)))));
  return map;
}

inline material_def_t rough() {
  material_def_t m{};
  m.friction_static = m.friction_dynamic = 0.5;
  m.bump_asset = 1, m.bump_size_u_m = m.bump_size_v_m = kWave_m, m.bump_height_m = kHigh_m;
  return m;
}

// Surfaces of a scene in which only the first material has the waves.
inline std::shared_ptr<AudioSurfaces> wavy_surfaces() {
  auto surfaces = std::make_shared<AudioSurfaces>();
  surfaces->by_material.push_back({std::make_shared<const ReliefLevels>(make_relief(waves(), rough())), nullptr});
  return surfaces;
}

inline sync::HostTime at_ms(double ms) { return sync::host_time(static_cast<std::int64_t>(1e9 + 1e6 * ms)); }

}  // namespace tactus::audio::test
