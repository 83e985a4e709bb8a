// Crosses, arrows, springs and axes of straight lines in space. Pure.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

struct Pen {
  Eigen::Vector4f colour{1, 1, 1, 1};  // sRGB; w: opacity
  float width_px = 2;
};

// A line with a coordinate that is not finite, or larger than kMaxCoordinate_m, is not drawn.
inline constexpr float kMaxCoordinate_m = 1e6f;

void append_line(std::vector<Stroke>& out, const Eigen::Vector3f& from, const Eigen::Vector3f& to, const Pen& pen);
// Three lines of that length along the world axes, crossing in their middle.
void append_cross(std::vector<Stroke>& out, const Eigen::Vector3f& at, float length_m, const Pen& pen);
// Four barbs, so that it is an arrow from every side; they take a quarter of its length.
void append_arrow(std::vector<Stroke>& out, const Eigen::Vector3f& from, const Eigen::Vector3f& along,
                  const Pen& pen);
// A zigzag of kSpringTurns.
inline constexpr int kSpringTurns = 6;
void append_spring(std::vector<Stroke>& out, const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width_m,
                   const Pen& pen);
// x red, y green, z blue.
void append_axes(std::vector<Stroke>& out, const Eigen::Isometry3d& pose, float length_m, const Pen& pen);

}  // namespace tactus::visual
