// The setting `engine`: one word that selects solver, detector and groups together.
#pragma once

#include <string>

#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Sets solver, detector and groups as the setting `engine` says; engine = parts changes nothing. Returns one sentence when another setting
// contradicts the engine, and empty text otherwise.
std::string apply_engine(Settings& settings);

}  // namespace tactus::sim
