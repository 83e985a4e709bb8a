// The modes of a struck object, as measured: the table that tactus analyse-modes writes.
#pragma once

#include <string_view>
#include <tactus/measured_mode_t.hpp>
#include <vector>

namespace tactus::sim {

// Rows of frequency_Hz, damping_1_s and amplitude, in columns of these names, among others; ascending. Throws
// std::runtime_error, with the row, when there is none, too many, or one that is no mode.
std::vector<measured_mode_t> parse_measured_modes(std::string_view csv);

}  // namespace tactus::sim
