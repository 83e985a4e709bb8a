// Values of elements: numbers, vectors, colours, poses. All functions reject a value that is not of its type or not
// finite, with file, line and path (std::runtime_error).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim_node/scene/sdf/element.h"
#include "sim_node/scene/sdf/pose.h"

namespace tactus::sim::sdf {

// The whole text as a finite number; the decimal separator is a point.
double number(const Element& element);
// Also inf and -inf, in any case of letters: limits and frictions.
double number_or_infinity(const Element& element);
// The number in a child; `missing` when there is no such child, or no element.
double child_number(const Element* element, std::string_view child_name, double missing);
// true, false, 1 or 0, in any case of letters; nullopt: another text.
std::optional<bool> parse_flag(std::string_view text);
bool flag(const Element& element);
// Of an attribute; false without it.
bool attribute_flag(const Element& element, std::string_view name);
bool child_flag(const Element* element, std::string_view child_name, bool missing);
// Exactly two or three numbers.
Eigen::Vector2d vector2(const Element& element);
Eigen::Vector3d vector3(const Element& element);
Eigen::Vector3d child_vector3(const Element* element, std::string_view child_name, const Eigen::Vector3d& missing);

// Red, green, blue and opacity, 0 .. 1, in single precision.
struct Colour {
  Eigen::Vector3d rgb;
  double alpha = 1;
};
// Three or four numbers of 0 .. 1.
Colour colour(const Element& element);
// nullopt: there is no such child.
std::optional<Colour> child_colour(const Element* element, std::string_view child_name);

// The numbers of a <pose>, without the frame that they are relative to: rotation_format="euler_rpy" (with degrees) or
// "quat_xyzw". Empty text is the identity.
Pose raw_pose(const Element& pose);
// The identity when the element has no <pose>.
Pose child_pose(const Element& element);

}  // namespace tactus::sim::sdf
