#include "sim_node/model/behaviour_model.h"

#include <array>
#include <stdexcept>

namespace tactus::sim {
namespace {

constexpr std::array<BehaviourModel, 5> kModels{{
    {.name = "quick"},  // iterative: ODE's QuickStep
    {.name = "step"},   // LCP: ODE's dWorldStep
    {.name = "impulse",  // collisions pair by pair, then contact
     .impulses = true,
     .needs_gaps = true,
     .needs_trees = true},
    {.name = "penalty",  // spring and damper in a shell, of the end of the step
     .impulses = true,
     .needs_gaps = true,
     .needs_trees = true,
     .bounces = false,
     .finite_forces = true},
    {.name = "penalty_explicit",  // the same, of the start of the step
     .impulses = true,
     .needs_gaps = true,
     .needs_trees = true,
     .has_stability_limit = true,
     .bounces = false,
     .finite_forces = true},
}};

}  // namespace

const BehaviourModel& behaviour_model(std::string_view name) {
  for (const BehaviourModel& m : kModels)
    if (m.name == name) return m;
  throw std::runtime_error("sim_node: the solver \"" + std::string(name) +
                           "\" is unknown; choose quick, step, impulse, penalty or penalty_explicit");
}

double contact_distance_m(const Settings& s) {
  return s.groups == "dual" || behaviour_model(s.solver).finite_forces ? s.contact_tolerance_m : 0;
}

}  // namespace tactus::sim
