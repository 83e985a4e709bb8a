// The solids that represent the bodies of a scene, with their modes and mode shapes. Pure.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "audio_node/modal/modal.h"
#include "audio_node/modal/mode_shape.h"

namespace tactus::audio {

struct SolidMode {
  double frequency_Hz;
  double gain;  // radiation efficiency: 1 for motion across the surface, less for motion along it
  ModeShape shape;
};

struct Solid {
  std::vector<SolidMode> modes;
  double volume_m3 = 0;
  double radius_m = 0;                                 // of a ball with the same radiation
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // frame of the solid (mode_shape.h) in that of the shape
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();  // in its own frame
};

// A block of these edges is a bar, a plate or a cube by their ratios. fixed: static, supported at its rim. patch:
// edges that are only a part of the body.
Solid solid_box(const Elastic& material, const Eigen::Vector3d& edges_m, bool fixed,
                const std::array<bool, 3>& patch, ModeRange range);
// Along z: a disc when it is flat.
Solid solid_cylinder(const Elastic& material, double radius_m, double length_m, ModeRange range);
// A shell when it is lighter than a solid ball.
Solid solid_sphere(const Elastic& material, double radius_m, double mass_kg, ModeRange range);

}  // namespace tactus::audio
