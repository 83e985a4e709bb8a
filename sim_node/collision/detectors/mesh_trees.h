// Triangle trees of a world's meshes, built once and shared by all shapes and users.
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "sim_node/collision/layers/mesh_contact.h"
#include "sim_node/collision/triangle_tree.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Share of the tolerance below which two distances count as equal. I-Touch's example uses 2 of 10.
inline constexpr double kEqualShare = 0.2;

// Not thread-safe, and for one world only. Any number of threads may use the returned trees.
class MeshTrees {
 public:
  // Tree of a mesh or heightfield, or of a box as twelve triangles. A plane becomes the plate that represents a
  // moving plane, in the frame of the plate.
  std::shared_ptr<const TriangleTree> triangles(const ShapeDef& shape, const WorldDef& world);
  // The same for the layers. Throws std::runtime_error with one sentence when an index or a vertex is invalid.
  std::shared_ptr<const ContactMesh> layers(const ShapeDef& shape, const WorldDef& world);

 private:
  std::map<std::pair<ShapeKind, int>, std::shared_ptr<const TriangleTree>> triangles_;
  std::map<std::pair<ShapeKind, int>, std::shared_ptr<const ContactMesh>> layers_;
};

}  // namespace tactus::sim
