// Identity of the world of a saved state: a hash of everything that determines its motion and is not state. Pure.
#pragma once

#include <cstdint>

#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Equal for two worlds exactly when a state of one can continue in the other.
std::uint64_t fingerprint(const WorldDef& world, const Settings& settings);

}  // namespace tactus::sim
