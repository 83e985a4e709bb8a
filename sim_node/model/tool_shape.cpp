#include "sim_node/model/tool_shape.h"

#include <algorithm>
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

double tool_bound_m(const WorldDef& world, const tool_def_t& tool) {
  switch (tool.shape) {
    case tool_def_t::BOX: return 0.5 * to_eigen(tool.size_m).norm();
    case tool_def_t::CAPSULE: return tool.size_m.x + 0.5 * tool.size_m.z;
    case tool_def_t::MESH: {
      double bound = 0;
      for (const Eigen::Vector3d& v : world.meshes[static_cast<std::size_t>(tool_mesh(tool))].vertices)
        bound = std::max(bound, v.norm());
      return bound;
    }
    default: return tool.radius_m;
  }
}

}  // namespace tactus::sim
