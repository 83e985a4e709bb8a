#include "sim_node/behaviour/behaviour_model.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

namespace tactus::sim {
namespace {

constexpr std::array<BehaviourModel, 5> kModels{{
    {.name = "quick", .what = "iterative: ODE's QuickStep"},
    {.name = "step", .what = "LCP: ODE's dWorldStep"},
    {.name = "impulse",
     .what = "impulses: collisions pair by pair, then contact",
     .impulses = true,
     .needs_gaps = true,
     .needs_trees = true},
    {.name = "penalty",
     .what = "spring and damper in a shell, of the end of the step",
     .impulses = true,
     .needs_gaps = true,
     .needs_trees = true,
     .bounces = false,
     .finite_forces = true},
    {.name = "penalty_explicit",
     .what = "spring and damper in a shell, of the start of the step",
     .impulses = true,
     .needs_gaps = true,
     .needs_trees = true,
     .has_stability_limit = true,
     .bounces = false,
     .finite_forces = true},
}};

// Surfaces meet at this gap, so that what the sweeps leave unsolved is no overlap; design: what overlap is
// allowed, 10 um, once more. Of it what is not repaired: a fifth, above the rounding of detectors.
constexpr double kShell_m = 1e-5, kSlack_m = 2e-6;

// Points that may press on a body in one direction: a ball has one, a face four.
int points_of(const WorldDef& world, int body) {
  for (const ShapeDef& s : world.shapes)
    if (s.body == body && s.kind != ShapeKind::kSphere) return kMaxManifoldPoints;
  return 1;
}

std::string too_stiff(const WorldDef& world, const Settings& s) {
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const BodyDef& b = world.bodies[i];
    if (b.is_static || b.tool >= 0) continue;
    const double mobility = points_of(world, static_cast<int>(i)) / b.mass_kg;
    const double most = impulse::stiffest_explicit(mobility, s.penalty_damping_Ns_m, s.step_s);
    if (s.penalty_stiffness_N_m < most) continue;
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, "%.3g kg bear at most %.3g N/m at a step of %.3g ms, not %.3g",
                  b.mass_kg, std::max(0.0, most), 1e3 * s.step_s, s.penalty_stiffness_N_m);
    return "sim_node: the solver \"penalty_explicit\" is unstable for the body \"" + b.name + "\", whose " +
           numbers + "; lower penalty_stiffness or choose \"penalty\"";
  }
  return "";
}

}  // namespace

std::span<const BehaviourModel> behaviour_models() { return kModels; }

const BehaviourModel& behaviour_model(std::string_view name) {
  for (const BehaviourModel& m : kModels)
    if (m.name == name) return m;
  throw std::runtime_error("sim_node: the solver \"" + std::string(name) +
                           "\" is unknown; choose quick, step, impulse, penalty or penalty_explicit");
}

std::string refusal(const BehaviourModel& model, const DetectorAbilities& detector) {
  if (!model.needs_gaps || detector.separation) return "";
  return "sim_node: the solver \"" + std::string(model.name) +
         "\" acts before surfaces meet, which the detector \"" + std::string(detector.name) +
         "\" does not see; choose a detector that sees gaps, as \"gaps\" does, or the solver \"quick\" or \"step\"";
}

std::string refusal(const WorldDef& world, const Settings& settings) {
  const BehaviourModel& model = behaviour_model(settings.solver);
  if (settings.groups == "dual" && model.name != "impulse" && model.name != "penalty_explicit")
    return "sim_node: groups = dual has penalty contact near the tools and impulses elsewhere, not the solver \"" +
           std::string(model.name) +
           "\"; choose solver = impulse, or penalty_explicit for springs of the start of the step near the tools, or "
           "groups = single";
  if (model.needs_gaps) {
    const std::string blind = refusal(model, make_detector(settings.detector)->abilities());
    if (!blind.empty()) return blind;
  }
  return model.has_stability_limit ? too_stiff(world, settings) : "";
}

impulse::Law law_of(const Settings& s) {
  impulse::Law law{.sweeps = s.iterations,
                   .bounce_speed_m_s = s.bounce_speed_m_s,
                   .slack_m = kSlack_m,
                   .repair = s.contact_erp,
                   .repair_speed_m_s = s.correcting_speed_m_s,
                   .shell_m = s.groups == "dual" ? s.contact_tolerance_m : kShell_m};
  if (behaviour_model(s.solver).finite_forces) {
    law.shell_m = kShell_m;
    law.penalty = {.stiffness_N_m = s.penalty_stiffness_N_m,
                   .damping_N_s_m = s.penalty_damping_Ns_m,
                   .thickness_m = s.contact_tolerance_m - kShell_m,  // ends where surfaces meet
                   .is_explicit = s.solver == "penalty_explicit",
                   .rise_m_s = s.correcting_speed_m_s};
  }
  return law;
}

double meeting_distance_m(const Settings& s) {
  return s.groups == "dual" || behaviour_model(s.solver).finite_forces ? s.contact_tolerance_m : 0;
}

}  // namespace tactus::sim
