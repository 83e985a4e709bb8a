// Finds a time in a log by bisection over its bytes: without an index, and with a few page reads for a log of any length.
// Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus::sync {

// The median stamp of the next few events at or after a byte, so that single damaged stamps do no harm. nullopt: there is no
// event.
std::optional<std::int64_t> stamp_near(std::span<const std::uint8_t> log, std::size_t at);

// A byte from which reading finds every event with this stamp or a later one, in a log whose stamps increase; shortly before
// the first of them.
std::size_t seek_log(std::span<const std::uint8_t> log, std::int64_t timestamp_us);

// Stamps of the first and the last event, without damaged ones. nullopt: the log has no event.
struct LogSpan {
  std::int64_t first_us, last_us;
};
std::optional<LogSpan> span_of_log(std::span<const std::uint8_t> log);

}  // namespace tactus::sync
