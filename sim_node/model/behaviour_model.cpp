#include "sim_node/model/behaviour_model.h"

#include <array>
#include <map>
#include <stdexcept>
#include <utility>

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

// Written before run() only, by the main function of a program that links this library.
std::map<std::string, BehaviourModel, std::less<>>& registered_models() {
  static std::map<std::string, BehaviourModel, std::less<>> all;
  return all;
}

}  // namespace

void register_behaviour_model(std::string name, BehaviourModel model) {
  const auto [i, added] = registered_models().try_emplace(std::move(name), model);
  if (!added) throw std::invalid_argument("sim_node: the behaviour model \"" + i->first + "\" is registered twice; give each its own name");
  i->second.name = i->first;
}

const BehaviourModel& behaviour_model(std::string_view name) {
  for (const BehaviourModel& m : kModels)
    if (m.name == name) return m;
  if (const auto i = registered_models().find(name); i != registered_models().end()) return i->second;
  if (name.starts_with("custom:"))
    throw std::runtime_error("sim_node: the solver \"" + std::string(name) + "\" is not part of this program; start the program that registers it");
  throw std::runtime_error("sim_node: the solver \"" + std::string(name) +
                           "\" is unknown; choose quick, step, impulse, penalty or penalty_explicit");
}

double contact_distance_m(const Settings& s) {
  return s.groups == "dual" || behaviour_model(s.solver).finite_forces ? s.contact_tolerance_m : 0;
}

}  // namespace tactus::sim
