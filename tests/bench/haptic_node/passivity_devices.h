// The part of passivity_table with devices that have their own period, delay and damping.
#pragma once

#include <nlohmann/json.hpp>

namespace tactus::bench {

// Prints a row for each surface, device, delay and damping, the worst of all hands and acts, and appends it to `rows`.
// full: the whole grid, otherwise its corners. all: prints every episode. Returns true when every row is within its
// limits: at most 1 mJ generated, observer within 0.5 mJ, no oscillation, walls at least 0.7 as stiff as theory allows.
bool device_table(nlohmann::json& rows, bool full, bool all);

// The same for the tick rate of the node, with a device that is read and commanded in the tick.
bool rate_table(nlohmann::json& rows);

}  // namespace tactus::bench
