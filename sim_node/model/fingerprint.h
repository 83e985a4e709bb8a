// Which world a state is of: a hash of all that moves it and is no state. Pure.
#pragma once

#include <cstdint>

#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Equal for two worlds exactly when a state of one continues in the other.
std::uint64_t fingerprint(const WorldDef& world, const Settings& settings);

}  // namespace tactus::sim
