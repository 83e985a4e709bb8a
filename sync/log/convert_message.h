// Converts messages of an earlier form of a type: renamed fields, fields of higher precision, new fields. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sync/log/log_contract.h"

namespace tactus::sync {

class MessageConverter {
 public:
  // recorded: all types of a log. Throws std::runtime_error with one sentence, whose subject is the log, when a type has fields
  // that this release cannot convert.
  explicit MessageConverter(std::vector<RecordedType> recorded);

  // The message in the form of this release. nullopt: its type has not changed, or the bytes are not one complete message.
  std::optional<std::vector<std::uint8_t>> convert(std::span<const std::uint8_t> message) const;

 private:
  struct Reader;
  const RecordedType* recorded_type(std::string_view name) const;
  bool convert_fields(const RecordedType& before, Reader& in, std::vector<std::uint8_t>& out) const;
  bool convert_one(std::string_view before, std::string_view now, Reader& in, std::vector<std::uint8_t>& out) const;

  std::vector<RecordedType> recorded_;
  std::map<std::int64_t, std::int64_t> changed_;                 // fingerprints
  std::map<std::string, std::vector<int>, std::less<>> places_;  // matching_fields of each recorded type
};

}  // namespace tactus::sync
