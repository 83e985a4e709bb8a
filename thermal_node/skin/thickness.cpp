#include "thermal_node/skin/thickness.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tactus/shape_def_t.hpp>

namespace tactus::thermal {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double thickness_of(const shape_def_t& s) {
  switch (s.kind) {
    case shape_def_t::BOX: return std::min({s.size_m.x, s.size_m.y, s.size_m.z});
    case shape_def_t::SPHERE:
    case shape_def_t::CAPSULE: return 2 * s.size_m.x;
    case shape_def_t::CYLINDER: return std::min(2 * s.size_m.x, s.size_m.z);
    default: return kInfinite;
  }
}

}  // namespace

std::vector<double> thickness_of_bodies(const scene_t& scene) {
  std::vector<double> thickness(scene.bodies.size(), 0);
  for (const shape_def_t& shape : scene.shapes) {
    if (shape.body < 0 || shape.body >= static_cast<int>(thickness.size())) continue;
    double& body = thickness[static_cast<std::size_t>(shape.body)];
    body = std::max(body, thickness_of(shape));
  }
  for (double& body : thickness)
    if (!(body > 0)) body = kInfinite;
  return thickness;
}

}  // namespace tactus::thermal
