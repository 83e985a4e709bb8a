// Converts a log with earlier forms of message types to the types of this release.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sync/log/log_writer.h"

namespace tactus::sync {

struct UpgradeCounts {
  std::int64_t events = 0;           // written
  std::int64_t converted = 0;        // messages of a changed type
  std::int64_t damaged_regions = 0;  // byte ranges without an intact event; left out
};

// Converts each message of a changed type (sync/log/convert_message.h), and replaces LOG_TYPES; everything else stays the same:
// channels, stamps, order and contents. If a converted page does not fit a datagram, all pages of its type are split in two
// (sync/log/split_page.h). A damaged message stays as it is. Throws std::runtime_error with one sentence, whose
// subject is the log, when the log has no LOG_TYPES or a type has other fields; and when the sink refuses the data.
UpgradeCounts upgrade_log(std::span<const std::uint8_t> log, std::unique_ptr<LogSink> sink);

}  // namespace tactus::sync
