// Modes of a struck body, from its material, shape, size and mass. Pure.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <tactus/body_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <vector>

#include "audio_node/modal/modal.h"
#include "audio_node/modal/mode_shape.h"
#include "audio_node/settings.gen.h"

namespace tactus::audio {

// Slower decay than any metal object: a material without damping must not ring for ever.
inline constexpr double kMinDamping_1_s = 0.5;  // T60 = 13.8 s, design

struct Mode {
  double frequency_Hz;
  double damping_1_s;
  double gain;      // velocity of the surface per impulse over mass, root mean square over the surface
  ModeShape shape;  // factor for a force at a given place
};

// A force on a body: place and direction (unit), in the frame of the body.
struct BodyPlace {
  Eigen::Vector3d point_m, direction;
};

struct BodySound {
  Elastic material;
  std::vector<Mode> modes;  // in order of increasing frequency
  double mass_kg = 1;       // of the vibrating part
  double radius_m = 0.05;   // of a ball of the same extent: determines the radiation
  // Measured modes keep their recorded strength, so all radiate as the strongest does.
  std::optional<double> radiation_frequency_Hz{};
  bool moves = true;
  Eigen::Isometry3d solid_to_body = Eigen::Isometry3d::Identity();  // T_body_solid
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();         // of the solid, in its frame
};

// Bounding box of a mesh, m, in the frame of its shape.
struct Extent {
  double x_m = 0, y_m = 0, z_m = 0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
};

// shape: null for a body without any. mesh: its extent if the shape is a mesh; empty: not known.
BodySound body_sound(const body_def_t& body, const shape_def_t* shape, const Elastic& material,
                     const std::optional<Extent>& mesh, const Settings& settings);

// Gain of a mode for a force at that place, or at the nearest point of the solid, in the units of Mode::gain. May
// be negative.
double gain_at(const BodySound& sound, const Mode& mode, const BodyPlace& place);

Elastic elastic(const material_def_t& material);

}  // namespace tactus::audio
