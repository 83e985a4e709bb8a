// CSV rows of the tables that are exported from a log: one per TOOL_STATE and one per THERMAL_STATE. Pure.
#pragma once

#include <string>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>

namespace tactus::sync {

// Lines of column names, with units, and of values; each ends with a newline. Times in s: simulated (empty when the message
// belongs to no instant of the world) and CLOCK_MONOTONIC of the sender. Lengths in m, forces in N, torques in N m, world
// frame. run: number of the run in its log, from 1.
std::string haptic_csv_names();
std::string csv_row(const tool_state_t&, int run = 1);
std::string thermal_csv_names();
std::string csv_row(const thermal_state_t&, int run = 1);

}  // namespace tactus::sync
