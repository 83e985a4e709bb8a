// Mass, centre of mass and inertia of a body from its shapes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

struct MassProperties {
  double mass_kg = 0;
  Eigen::Vector3d centre_of_mass_m{0, 0, 0};                 // in the body frame
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  // about the centre of mass, body axes
};

// A mesh whose volume is not exactly known: the name of its shape, and a clause that completes "the mesh ...".
struct MassRemark {
  std::string shape, clause;
};

// Overlaps count twice. Each shape has the density of its material; if any shape has none, all have 1 kg/m^3 and only
// the ratios are meaningful. Planes and heightfields have no mass. A mesh has the volume that it encloses, whichever way it
// faces (sim_node/model/mesh_solid.h). `has_density`: whether all shapes have a material. `remarks`: appended to, if given.
MassProperties mass_of(const WorldDef& world, std::span<const ShapeDef> shapes, bool& has_density,
                       std::vector<MassRemark>* remarks = nullptr);

// The same body with another mass; the inertia is scaled in proportion.
MassProperties scaled_to(MassProperties properties, double mass_kg);

}  // namespace tactus::sim
