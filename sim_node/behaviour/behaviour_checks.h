// Start-up checks of the compatibility of scene, detector and behaviour model. They return a reason instead of
// throwing.
#pragma once

#include <string>

#include "sim_node/model/behaviour_model.h"
#include "sim_node/collision/detector.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Returns an empty string when the detector supports the model, else one sentence that names an alternative.
std::string unsupported_reason(const BehaviourModel& model, const DetectorAbilities& detector);
// Returns an empty string when the model of these settings can simulate this scene, else one sentence with the
// remedy. The builder of the systems detects loops of joints.
std::string unsupported_reason(const WorldDef& world, const Settings& settings);

}  // namespace tactus::sim
