// What of a world may be set while it runs: named, counted, in range. Pure.
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
  std::size_t count;  // numbers
  double low, high;   // of each
  const char* meaning;
};

std::span<const PropertyRow> properties();

// A body by its name, or by that of its model when it has one link only; -1: there is none.
int find_body(const WorldDef& world, const std::string& name);

// Sets it. Returns why not, in one sentence; then nothing has changed. Empty: it is set.
// of: a body, a joint, or "world".
std::string set_property(Simulation& simulation, const WorldDef& world, const std::string& of,
                         const std::string& property, std::span<const double> values);

// A push at the centre of mass of a body, likewise.
std::string push_body(Simulation& simulation, const WorldDef& world, const std::string& body,
                      const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m,
                      sync::Nanoseconds duration);

}  // namespace tactus::sim
