#include "sim_node/model/tool_shape.h"

#include <algorithm>
#include <cmath>
#include <tactus/tool_def_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::sim {

ShapeDef tool_shape(const tool_def_t& tool) {
  ShapeDef s;
  s.name = tool.name;
  s.body = tool.body;
  s.material = tool.material;
  s.size_m = to_eigen(tool.size_m);
  switch (tool.shape) {
    case tool_def_t::BOX: s.kind = ShapeKind::kBox; break;
    case tool_def_t::CAPSULE: s.kind = ShapeKind::kCapsule; break;
    case tool_def_t::MESH:
      s.kind = ShapeKind::kMesh;
      s.mesh = tool_mesh(tool);
      s.size_m.setOnes();
      break;
    default: s.kind = ShapeKind::kSphere; s.size_m = {tool.radius_m, 0, 0};
  }
  return s;
}

double bound_m(const WorldDef& world, const ShapeDef& s) {
  switch (s.kind) {
    case ShapeKind::kSphere: return s.size_m.x();
    case ShapeKind::kCapsule: return s.size_m.x() + s.size_m.z() / 2;
    case ShapeKind::kCylinder: return std::hypot(s.size_m.x(), s.size_m.z() / 2);
    case ShapeKind::kMesh: {
      double max_radius_m = 0;
      for (const Eigen::Vector3d& v : world.meshes[static_cast<std::size_t>(s.mesh)].vertices)
        max_radius_m = std::max(max_radius_m, v.norm());
      return max_radius_m;
    }
    default: return s.size_m.norm() / 2;
  }
}

}  // namespace tactus::sim
