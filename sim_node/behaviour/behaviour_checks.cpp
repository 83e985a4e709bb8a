#include "sim_node/behaviour/behaviour_checks.h"

#include <algorithm>
#include <cstdio>

#include "sim_node/behaviour/impulse/penalty.h"
#include "sim_node/model/manifold.h"

namespace tactus::sim {
namespace {

// Number of points that may press on a body in one direction: one for a ball, four for a face.
int points_of(const WorldDef& world, int body) {
  for (const ShapeDef& s : world.shapes)
    if (s.body == body && s.kind != ShapeKind::kSphere) return kMaxFacePoints;
  return 1;
}

std::string too_stiff(const WorldDef& world, const Settings& s) {
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const BodyDef& b = world.bodies[i];
    if (b.is_static || b.tool >= 0) continue;
    const double mobility = points_of(world, static_cast<int>(i)) / b.mass_kg;
    const double max_stiffness_N_m =
        impulse::max_explicit_stiffness_N_m(mobility, s.penalty_damping_Ns_m, s.step_s);
    if (s.penalty_stiffness_N_m < max_stiffness_N_m) continue;
    char numbers[160];
    std::snprintf(numbers, sizeof numbers,
                  "mass of %.3g kg allows at most %.3g N/m at a step of %.3g ms, not %.3g", b.mass_kg,
                  std::max(0.0, max_stiffness_N_m), 1e3 * s.step_s, s.penalty_stiffness_N_m);
    return "sim_node: the solver \"penalty_explicit\" is unstable for the body \"" + b.name + "\", whose " +
           numbers + "; lower penalty_stiffness or choose \"penalty\"";
  }
  return "";
}

}  // namespace

std::string unsupported_reason(const BehaviourModel& model, const DetectorAbilities& detector) {
  if (!model.needs_gaps || detector.separation) return "";
  return "sim_node: the solver \"" + std::string(model.name) +
         "\" needs contacts with gaps, which the detector \"" + std::string(detector.name) +
         "\" does not report; choose a detector that reports gaps, such as \"gaps\", or the solver \"quick\" or \"step\"";
}

std::string unsupported_reason(const WorldDef& world, const Settings& settings) {
  const BehaviourModel& model = behaviour_model(settings.solver);
  if (settings.groups == "dual" && model.name != "impulse" && model.name != "penalty_explicit")
    return "sim_node: groups = dual has penalty contact near the tools and impulses elsewhere, not the solver \"" +
           std::string(model.name) +
           "\"; choose solver = impulse, or penalty_explicit for explicit springs near the tools, or "
           "groups = single";
  if (model.needs_gaps) {
    const std::string blind = unsupported_reason(model, make_detector(settings.detector)->abilities());
    if (!blind.empty()) return blind;
  }
  return model.has_stability_limit ? too_stiff(world, settings) : "";
}

}  // namespace tactus::sim
