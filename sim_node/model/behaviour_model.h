// Contact laws that a scene may select (setting `solver`), and the requirements of each.
#pragma once

#include <string>
#include <string_view>

#include "sim_node/settings.gen.h"

namespace tactus::sim {

struct BehaviourModel {
  std::string_view name;
  // Solved by impulse::World for free bodies and systems of joints; otherwise by ODE.
  bool impulses = false;
  // Acts before surfaces meet, and corrects remaining overlaps by positions. Contacts must therefore carry their
  // gaps: a pair that was separated would otherwise stop being a contact and would never be solved. The other
  // models accept overlaps only.
  bool needs_gaps = false;
  // Joints must not form a loop.
  bool needs_trees = false;
  // Stiffness is limited by step and mass.
  bool has_stability_limit = false;
  bool bounces = true;  // by restitution; otherwise restitution applies only to bodies too fast for the spring
  bool finite_forces = false;  // forces are finite and continuous; otherwise an impact takes one step
};

// Adds the properties of a behaviour model of another program; its name begins with "custom:". Call it before run() and from one thread.
// register_behaviour (behaviour/mechanics.h) calls it. Throws std::invalid_argument when the name is taken.
void register_behaviour_model(std::string name, BehaviourModel model);

// Throws std::runtime_error with one sentence when the name is unknown.
const BehaviourModel& behaviour_model(std::string_view name);

// Gap at which surfaces start to interact, m: the reach of springs, in both groups of a dual simulation, so that the
// contact does not change when a body moves between groups. 0 for models without springs.
double contact_distance_m(const Settings& settings);

}  // namespace tactus::sim
