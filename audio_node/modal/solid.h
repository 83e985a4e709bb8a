// The solids that stand for the bodies of a scene, with their modes and how these move them. Pure.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "audio_node/modal/modal.h"
#include "audio_node/modal/mode_shape.h"

namespace tactus::audio {

struct SolidMode {
  double frequency_Hz;
  double gain;  // how well its motion moves the air: 1 across the surface, less along it
  ModeShape shape;
};

struct Solid {
  std::vector<SolidMode> modes;
  double volume_m3 = 0;
  double radius_m = 0;                                 // of a ball that radiates as well
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // the solid's frame (mode_shape.h) in that of the shape
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();  // in its own frame
};

// A block of these edges is a bar, a plate or a cube by their ratios. fixed: it stands still, supported at its
// rim; patch: which of its edges are only a part of the body's.
Solid solid_box(const Elastic& material, const Eigen::Vector3d& edges_m, bool fixed,
                const std::array<bool, 3>& patch, Range range);
// Along z: a disc when it is flat.
Solid solid_cylinder(const Elastic& material, double radius_m, double length_m, Range range);
// A shell when it is lighter than a solid one.
Solid solid_sphere(const Elastic& material, double radius_m, double mass_kg, Range range);

}  // namespace tactus::audio
