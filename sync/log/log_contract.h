// Compares the message types of a log (LOG_TYPES) with those of this release. Pure.
//
// The first 8 bytes of a message are the fingerprint of its type. LCM computes it from the names and types of the fields, so a
// renamed field changes the fingerprint although every other byte stays the same.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace tactus::sync {

// A type as the log describes it. A field is the text of its line: "contact_event_t events[count]".
struct RecordedType {
  std::string name;
  std::int64_t fingerprint = 0;
  std::vector<std::string> fields;
};

// The types in the head of a log, in their order; empty when the head has no complete LOG_TYPES.
std::vector<RecordedType> recorded_types(std::span<const std::uint8_t> log);

// The fingerprint of each changed type, as recorded, and that of the same type in this release.
// Throws std::runtime_error with one sentence when a type has other fields than in this release, apart from renamed ones.
std::map<std::int64_t, std::int64_t> renamed_types(const std::vector<RecordedType>& recorded);

// Throws std::runtime_error with one sentence when the log has messages of another contract. path: named in the sentence.
void require_current_types(std::span<const std::uint8_t> log, const std::string& path);

}  // namespace tactus::sync
