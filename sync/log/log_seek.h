// Where a time lies in a log, found by bisection over its bytes: no index, and a few pages read of a log of any
// length. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus::sync {

// The median stamp of the next few events at or behind a byte, so that single damaged stamps mislead nobody.
// Nothing: there is no event.
std::optional<std::int64_t> stamp_near(std::span<const std::uint8_t> log, std::size_t at);

// A byte from which reading on meets every event with this stamp or a later one, of a log whose stamps rise; not
// far before the first of them.
std::size_t seek_log(std::span<const std::uint8_t> log, std::int64_t timestamp_us);

// Stamps of the first and the last event, without those that damage has moved away. Nothing: the log has no event.
struct LogSpan {
  std::int64_t first_us, last_us;
};
std::optional<LogSpan> span_of_log(std::span<const std::uint8_t> log);

}  // namespace tactus::sync
