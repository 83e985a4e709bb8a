// The shapes of a world as ODE's geometries, and the contacts between them as manifolds.
#pragma once

#include <utility>
#include <vector>

#include "sim_node/behaviour/ode_handles.h"
#include "sim_node/collision/manifold.h"
#include "sim_node/scene/world_def.h"

namespace tactus::sim::ode {

class Shapes {
 public:
  // bodies: ODE's body of each of the world's, null for those that never move. Tools get no shape: they are ghosts.
  Shapes(const WorldDef& world, const std::vector<dBodyID>& bodies);

  // All contacts of the present poses, ordered by (shape_a, shape_b), so that the same world gives the same order.
  // Realtime-safe once the lists have grown.
  void collide(std::vector<Manifold>& out);

 private:
  struct Triangles {  // ODE keeps pointers to them
    std::vector<double> vertices;
    std::vector<dTriIndex> indices;
    Owned<dTriMeshDataID> data;
  };
  static void near(void* self, dGeomID a, dGeomID b);
  dGeomID make(const WorldDef& world, const ShapeDef& shape, bool is_static);
  dGeomID make_mesh(const TriangleMesh& mesh);
  dGeomID make_heightfield(const Heightfield& field);
  bool may_collide(int body_a, int body_b) const;

  std::vector<Triangles> triangles_;
  std::vector<Owned<dHeightfieldDataID>> heightfields_;
  Owned<dSpaceID> space_;
  std::vector<int> body_of_;                // per shape
  std::vector<bool> is_mesh_;               // per shape
  std::vector<std::pair<int, int>> apart_;  // sorted pairs of bodies that do not collide
  std::vector<dContactGeom> raw_;
  std::vector<ManifoldPoint> found_;
  std::vector<Manifold>* out_ = nullptr;
};

}  // namespace tactus::sim::ode
