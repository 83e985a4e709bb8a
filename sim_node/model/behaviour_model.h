// The laws that may move the bodies of a scene, behind one solver (setting `solver`), and what each needs.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sim_node/settings.gen.h"

namespace tactus::sim {

struct BehaviourModel {
  std::string_view name, what;
  // Solved by impulse::World, free bodies and systems of joints alike; else by ODE.
  bool impulses = false;
  // Acts before surfaces meet, and puts apart what overlaps all the same: contacts have to say how far they still are
  // apart, or what was put apart would be no contact any more and never be solved. The others make do with overlap.
  bool needs_gaps = false;
  // Joints must not close a loop.
  bool needs_trees = false;
  // Only so stiff as step and mass allow.
  bool has_stability_limit = false;
  bool bounces = true;  // by restitution; else only what is too fast for the spring, which throws back the rest
  bool finite_forces = false;  // which also are continuous; else a blow is over in one step
};

std::span<const BehaviourModel> behaviour_models();
// Throws std::runtime_error with one sentence when the name is unknown.
const BehaviourModel& behaviour_model(std::string_view name);

// The gap at which surfaces begin to act on each other, m: where springs do, and, so that nothing changes when a body goes
// from one group to the other, in both groups of a dual simulation. Else they meet at none.
double meeting_distance_m(const Settings& settings);

}  // namespace tactus::sim
