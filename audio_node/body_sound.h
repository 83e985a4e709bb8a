// How a body of the scene sounds when it is struck: its modes, from its material, shape, size and mass. Pure.
#pragma once

#include <optional>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/modal.h"
#include "audio_node/settings.gen.h"

namespace tactus::audio {

struct Mode {
  double frequency_Hz;
  double damping_1_s;
  double gain;  // velocity of the surface per impulse over mass, mean over the surface
};

struct BodySound {
  Elastic material;
  std::vector<Mode> modes;  // ascending
  double mass_kg = 1;       // of what vibrates
  double radius_m = 0.05;   // of a ball of the same extent: how well it radiates
  bool moves = true;
};

// Bounding box of a mesh, m, in the frame of its shape; nothing when the mesh is not known.
struct Extent {
  double x_m = 0, y_m = 0, z_m = 0;
};

// shape: null for a body without any. mesh: its extent where the shape is one.
BodySound body_sound(const body_def_t& body, const shape_def_t* shape, const Elastic& material,
                     const std::optional<Extent>& mesh, const Settings& settings);

Elastic elastic(const material_def_t& material);

}  // namespace tactus::audio
