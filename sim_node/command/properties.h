// Properties of a world that can be set at run time, with their names, counts and ranges. Pure.
#pragma once

#include <span>
#include <string>

#include "sim_node/world/simulation.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

enum class Owner { kWorld, kBody, kJoint };

struct PropertyRow {
  Owner owner;
  const char* name;
  const char* unit;
  std::size_t count;  // number of values
  double low, high;   // of each value
  const char* meaning;
};

std::span<const PropertyRow> properties();

// Index of a body by its name, or by the name of its model when the model has one link; -1: not found.
int find_body(const WorldDef& world, const std::string& name);

// Sets a property. of: a body, a joint, or "world". Returns an empty string on success, else one sentence with the
// error; then nothing has changed.
std::string set_property(Simulation& simulation, const WorldDef& world, const std::string& of,
                         const std::string& property, std::span<const double> values);

// Pushes a body at its centre of mass. Returns the same as set_property().
std::string push_body(Simulation& simulation, const WorldDef& world, const std::string& body,
                      const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m,
                      sync::Nanoseconds duration);

}  // namespace tactus::sim
