#include "sim_node/collision/detectors/mesh_trees.h"

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/model/triangles.h"

namespace tactus::sim {
namespace {

// Maximum number of samples along one side of a heightfield. Finer fields are thinned.
constexpr int kMaxSamples = 1025;

TriangleMesh mesh_of_box(const Eigen::Vector3d& half) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).cwiseProduct(half));
  m.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return m;
}

bool is_shared(const ShapeDef& s) { return s.kind == ShapeKind::kMesh || s.kind == ShapeKind::kHeightfield; }

// Calls use(mesh) with the mesh of a shape, or with a mesh made for it.
template <class Use>
auto with_mesh(const ShapeDef& shape, const WorldDef& world, Use&& use) {
  const auto at = static_cast<std::size_t>(shape.mesh);
  if (shape.kind == ShapeKind::kMesh) return use(world.meshes.at(at));
  if (shape.kind == ShapeKind::kHeightfield) return use(triangulate(world.heightfields.at(at), kMaxSamples));
  return use(mesh_of_box(gaps::convex_of(shape).half_m));
}

}  // namespace

std::shared_ptr<const TriangleTree> MeshTrees::triangles(const ShapeDef& shape, const WorldDef& world) {
  const auto make = [&] {
    return with_mesh(shape, world, [](const TriangleMesh& m) {
      return std::make_shared<const TriangleTree>(m.vertices, m.indices);
    });
  };
  if (!is_shared(shape)) return make();
  auto& tree = triangles_[{shape.kind, shape.mesh}];
  if (!tree) tree = make();
  return tree;
}

std::shared_ptr<const ContactMesh> MeshTrees::layers(const ShapeDef& shape, const WorldDef& world) {
  const auto make = [&] {
    return with_mesh(shape, world, [](const TriangleMesh& m) {
      return std::make_shared<const ContactMesh>(m.vertices, m.indices);
    });
  };
  if (!is_shared(shape)) return make();
  auto& mesh = layers_[{shape.kind, shape.mesh}];
  if (!mesh) mesh = make();
  return mesh;
}

}  // namespace tactus::sim
