// Ranges that hold for a number, a text and a header of whatever message. Only valid*.cpp include it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tactus/header_t.hpp>

namespace tactus {

// Farther than any scene and faster than any body: beyond this a number is garbage, though finite.
inline constexpr double kMaxMagnitude = 1e9;
// 31 years since a machine or a world began: differences of such times do not overflow.
inline constexpr long kMaxTime_ns = 1'000'000'000'000'000'000;

inline bool sane(double x) { return std::isfinite(x) && std::abs(x) <= kMaxMagnitude; }
inline bool between(long value, long low, long high) { return value >= low && value <= high; }

// Of a node or a modality: it becomes a key, a file's column and a line on a terminal.
inline bool printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}
inline bool name(const std::string& text) { return !text.empty() && text.size() <= 64 && printable(text); }

inline bool sane(const header_t& h) {
  return between(h.sim_time_ns, -1, kMaxTime_ns) && between(h.publish_time_ns, 0, kMaxTime_ns) && h.run_id > 0 &&
         h.incarnation > 0 && h.seq >= 0;
}

}  // namespace tactus
