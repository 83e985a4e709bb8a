// The shapes of a world as ODE geometries, and the contacts between them as manifolds.
#pragma once

#include <utility>
#include <vector>

#include "sim_node/collision/detectors/ode_handles.h"
#include "sim_node/collision/detectors/chosen_detector.h"
#include "sim_node/model/manifold.h"
#include "sim_node/collision/detectors/ode_geoms.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim::ode {

class Shapes {
 public:
  // bodies: ODE's body for each body of the world, null for static ones. Tools have no geometry. Throws
  // std::runtime_error with one sentence when the detector that the settings select does not support a shape.
  Shapes(const WorldDef& world, const std::vector<dBodyID>& bodies, const Settings& settings);

  // Writes all contacts of the current poses, ordered by (shape_a, shape_b), so that equal worlds give equal order.
  // Real-time safe once the lists have grown.
  void collide(std::vector<Manifold>& out);

 private:
  struct Box {
    dGeomID geom;
    dReal side[6];  // minimum and maximum of x, y, z
  };
  static void near(void* self, dGeomID a, dGeomID b);
  bool may_collide(int body_a, int body_b) const;
  void sweep(double reach_m);
  void collide_by_ode(std::size_t a, dGeomID geom_a, std::size_t b, dGeomID geom_b);

  Geoms geoms_;
  Owned<dSpaceID> space_;
  std::vector<int> body_of_;                // per shape
  std::vector<bool> is_mesh_shape_;         // per shape
  std::vector<std::pair<int, int>> excluded_pairs_;  // sorted pairs of bodies that do not collide
  std::vector<dContactGeom> raw_;
  std::vector<ManifoldPoint> found_;
  ChosenDetector chosen_;
  std::vector<Box> boxes_;
  std::vector<Manifold>* out_ = nullptr;
};

}  // namespace tactus::sim::ode
