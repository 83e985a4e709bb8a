// Shapes as ODE geometries. Only files named ode_*.cpp include this.
#pragma once

#include <map>
#include <vector>

#include "sim_node/collision/detectors/ode_handles.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim::ode {

// Creates geometries of one world and owns the data that they refer to, so it must outlive them. Shapes of one mesh
// share its tree.
class Geoms {
 public:
  // is_static: true makes a plane infinite, with `pose` in the world; false makes it a plate of finite size.
  dGeomID make(const WorldDef& world, const ShapeDef& shape, bool is_static, const Eigen::Isometry3d& pose);
  // Pose of ODE's geometry for a shape at `pose`. ODE's heightfields have y up, and a plate lies below its plane.
  static Eigen::Isometry3d geom_pose(const WorldDef& world, const ShapeDef& shape, const Eigen::Isometry3d& pose);

 private:
  struct Triangles {  // ODE keeps pointers to these arrays
    std::vector<double> vertices;
    std::vector<dTriIndex> indices;
    Owned<dTriMeshDataID> data;
  };
  dGeomID make_mesh(const WorldDef& world, int mesh);
  dGeomID make_heightfield(const Heightfield& field);

  std::map<int, Triangles> triangles_;  // by mesh index
  std::vector<Owned<dHeightfieldDataID>> heightfields_;
};

}  // namespace tactus::sim::ode
