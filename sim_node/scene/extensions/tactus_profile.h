// The degradation profile that a scene brings: <tactus:profile> with its <tactus:degrade>, or the name of a file.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Fills WorldDef::profile with its XML, as sync/degradation reads it. Refuses what is wrong, with its line.
void read_profile(LoadContext& context, const sdf::ElementPtr& world);

}  // namespace tactus::sim
