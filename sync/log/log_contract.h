// Compares the message types of a log (LOG_TYPES) with those of this release. Pure.
//
// The first 8 bytes of a message are the fingerprint of its type. LCM computes it from the names and types of the fields. A field
// may since have a new name or a type of higher precision, or be new: sync/log/convert_message.h converts such messages.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/fields.h"

namespace tactus::sync {

// A type as the log describes it. A field is the text of its line: "contact_event_t events[count]".
struct RecordedType {
  std::string name;
  std::int64_t fingerprint = 0;
  std::vector<std::string> fields;
};

// The types in the head of a log, in their order; empty when the head has no complete LOG_TYPES.
std::vector<RecordedType> recorded_types(std::span<const std::uint8_t> log);

// The parts of the line of a recorded field. count: of a list, else empty.
struct RecordedField {
  std::string_view type, name, count;
};
RecordedField parse_field(std::string_view line);

// For each field of a type in this release, its place among the recorded fields; -1: the field is new, and its value is 0.
// nullopt: the recorded type cannot be converted.
std::optional<std::vector<int>> matching_fields(const RecordedType& recorded, const MessageType& now);

// The fingerprint of each changed type, as recorded, and that of the same type in this release.
// Throws std::runtime_error with one sentence when a type cannot be converted.
std::map<std::int64_t, std::int64_t> renamed_types(const std::vector<RecordedType>& recorded);

// Throws std::runtime_error with one sentence when the log has messages of another contract. path: named in the sentence.
void require_current_types(std::span<const std::uint8_t> log, const std::string& path);

}  // namespace tactus::sync
