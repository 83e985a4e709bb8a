// Measured modes of a struck object: parser of the table that tactus analyse-modes writes.
#pragma once

#include <string_view>
#include <tactus/measured_mode_t.hpp>
#include <vector>

namespace tactus::sim {

// Returns the rows of the columns frequency_Hz, damping_1_s and amplitude, ascending; other columns are ignored.
// Throws std::runtime_error with the row when the table has no rows, too many rows or an invalid mode.
std::vector<measured_mode_t> parse_measured_modes(std::string_view csv);

}  // namespace tactus::sim
