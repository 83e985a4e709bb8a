// Checks that a scene, its detector and its behaviour model work together. Throws nothing; a pairing that cannot work is refused
// before anything starts.
#pragma once

#include <string>

#include "sim_node/model/behaviour_model.h"
#include "sim_node/collision/detector.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Empty when this detector serves the model; else one sentence with what to choose instead.
std::string refusal(const BehaviourModel& model, const DetectorAbilities& detector);
// Empty when the model of these settings can move the bodies of this scene; else one sentence with what to do.
// Loops of joints are found by the builder of the systems.
std::string refusal(const WorldDef& world, const Settings& settings);

}  // namespace tactus::sim
