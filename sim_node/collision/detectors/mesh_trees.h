// The trees over the triangles of a world's meshes, each made once, however many shapes and whoever use it.
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "sim_node/collision/layers/mesh_contact.h"
#include "sim_node/collision/triangle_tree.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Not for two threads at once, and for one world only; what it gave may be used by any number of threads.
class MeshTrees {
 public:
  // Of a mesh or heightfield, or of a box as twelve triangles; a plane is the plate that stands for one that
  // moves, in the frame of that.
  std::shared_ptr<const TriangleTree> triangles(const ShapeDef& shape, const WorldDef& world);
  // The same. Throws std::runtime_error with one sentence when an index or a vertex makes no sense.
  std::shared_ptr<const ContactMesh> layers(const ShapeDef& shape, const WorldDef& world);

 private:
  std::map<std::pair<ShapeKind, int>, std::shared_ptr<const TriangleTree>> triangles_;
  std::map<std::pair<ShapeKind, int>, std::shared_ptr<const ContactMesh>> layers_;
};

}  // namespace tactus::sim
