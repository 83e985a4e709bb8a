// Plausible ranges of numbers, texts and headers of any message. Only valid*.cpp include it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tactus/header_t.hpp>

namespace tactus {

// Limit of magnitudes: larger than any scene or speed, so a larger finite number is garbage.
inline constexpr double kMaxMagnitude = 1e9;
// 31 years since the start of a machine or a world: differences of such times do not overflow.
inline constexpr long kMaxTime_ns = 1'000'000'000'000'000'000;

inline bool sane(double x) { return std::isfinite(x) && std::abs(x) <= kMaxMagnitude; }
inline bool sane_not_negative(double x) { return sane(x) && x >= 0; }
inline bool between(long value, long low, long high) { return value >= low && value <= high; }

// 36 years of uptime: sums and differences of such times cannot overflow.
inline constexpr long kLatestClockTime = 1L << 60;
inline bool clock_time(long ns) { return between(ns, 0, kLatestClockTime); }

// The name of a node or modality becomes a key, a column of a file and a line on a terminal.
inline bool printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}
inline bool name(const std::string& text) { return !text.empty() && text.size() <= 64 && printable(text); }

inline bool sane(const header_t& h) {
  return between(h.sim_time_ns, -1, kMaxTime_ns) && between(h.publish_time_ns, 0, kMaxTime_ns) && h.run_id > 0 &&
         h.incarnation > 0 && h.seq >= 0;
}

}  // namespace tactus
