#include "sync/log/convert_message.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "lcmtypes/fields.h"

namespace tactus::sync {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kFingerprintBytes = 8;

// Bytes of a number on the wire; 0: text or a struct.
std::size_t width(std::string_view type) {
  if (type == "int8_t" || type == "byte" || type == "boolean") return 1;
  if (type == "int16_t") return 2;
  if (type == "int32_t" || type == "float") return 4;
  if (type == "int64_t" || type == "double") return 8;
  return 0;
}

// Big-endian, as LCM writes them.
void append(Bytes& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = bytes; i-- > 0;) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

// Reads forward; nullopt at a premature end.
struct MessageConverter::Reader {
  std::span<const std::uint8_t> left;
  std::map<std::string_view, std::int64_t> counts{};  // whole numbers of the present struct

  std::optional<std::uint64_t> take(std::size_t bytes) {
    if (bytes > left.size()) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | left[i];
    left = left.subspan(bytes);
    return value;
  }
  // Number of elements of a field. An element has at least one byte, so that a larger number is invalid.
  std::optional<std::size_t> length(std::string_view count) const {
    if (count.empty()) return 1;
    std::int64_t n = -1;
    const auto found = counts.find(count);
    if (found != counts.end())
      n = found->second;
    else
      std::from_chars(count.data(), count.data() + count.size(), n);
    if (n < 0 || static_cast<std::uint64_t>(n) > left.size()) return std::nullopt;
    return static_cast<std::size_t>(n);
  }
};

MessageConverter::MessageConverter(std::vector<RecordedType> recorded)
    : recorded_(std::move(recorded)), changed_(renamed_types(recorded_)) {
  // A second description would belong to other fields than those that were compared.
  for (std::size_t i = 0; i < recorded_.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (recorded_[i].name == recorded_[k].name || recorded_[i].fingerprint == recorded_[k].fingerprint)
        throw std::runtime_error("describes the message type " + recorded_[i].name + " twice in LOG_TYPES, so it cannot be converted; " +
                                 "use the recording as the recorder wrote it");
  for (const RecordedType& type : recorded_)
    if (const MessageType* now = message_type(type.name))
      if (auto places = matching_fields(type, *now)) places_[type.name] = std::move(*places);
}

const RecordedType* MessageConverter::recorded_type(std::string_view name) const {
  const auto found = std::find_if(recorded_.begin(), recorded_.end(), [&](const RecordedType& t) { return t.name == name; });
  return found == recorded_.end() ? nullptr : &*found;
}

std::optional<Bytes> MessageConverter::convert(std::span<const std::uint8_t> message) const {
  Reader in{message};
  const auto fingerprint = in.take(kFingerprintBytes);
  const auto change = fingerprint ? changed_.find(static_cast<std::int64_t>(*fingerprint)) : changed_.end();
  if (change == changed_.end()) return std::nullopt;
  const auto type = std::find_if(recorded_.begin(), recorded_.end(), [&](const RecordedType& t) { return t.fingerprint == change->first; });
  Bytes out;
  out.reserve(message.size() + message.size() / 4);
  append(out, static_cast<std::uint64_t>(change->second), kFingerprintBytes);
  if (!convert_fields(*type, in, out) || !in.left.empty()) return std::nullopt;
  return out;
}

bool MessageConverter::convert_fields(const RecordedType& before, Reader& in, Bytes& out) const {
  const MessageType* now = message_type(before.name);
  const auto places = places_.find(before.name);
  if (!now || places == places_.end()) return false;
  const auto outer = std::exchange(in.counts, {});
  for (std::size_t i = 0; i < now->fields.size(); ++i) {
    const Field& field = now->fields[i];
    const int place = places->second[i];
    if (place < 0) {
      if (field.type == "string")
        append(out, 1, 4), append(out, 0, 1);  // an empty text: its length with the final zero
      else
        append(out, 0, width(field.type));
      continue;
    }
    const RecordedField old = parse_field(before.fields[static_cast<std::size_t>(place)]);
    const auto n = in.length(old.count);
    if (!n) return false;
    if (old.count.empty() && width(old.type) > 0 && old.type != "float" && old.type != "double") {
      const auto value = in.take(width(old.type));
      if (!value) return false;
      const auto shift = static_cast<int>(64 - 8 * width(old.type));
      in.counts[old.name] = static_cast<std::int64_t>(*value << shift) >> shift;
      append(out, *value, width(old.type));
      continue;
    }
    for (std::size_t k = 0; k < *n; ++k)
      if (!convert_one(old.type, field.type, in, out)) return false;
  }
  in.counts = outer;
  return true;
}

bool MessageConverter::convert_one(std::string_view before, std::string_view now, Reader& in, Bytes& out) const {
  if (before == "string") {
    const auto size = in.take(4);
    if (!size || *size > in.left.size()) return false;
    append(out, *size, 4);
    out.insert(out.end(), in.left.begin(), in.left.begin() + static_cast<std::ptrdiff_t>(*size));
    in.left = in.left.subspan(*size);
    return true;
  }
  if (const std::size_t bytes = width(before)) {
    const auto value = in.take(bytes);
    if (!value) return false;
    if (before == now)
      append(out, *value, bytes);
    else
      append(out, std::bit_cast<std::uint64_t>(static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(*value)))), 8);
    return true;
  }
  const RecordedType* type = recorded_type(before);
  if (!type) return false;
  if (before == now) return convert_fields(*type, in, out);
  // A vector of single precision becomes one of double precision, component by component.
  for (int k = 0; k < 3; ++k)
    if (!convert_one("float", "double", in, out)) return false;
  return true;
}

}  // namespace tactus::sync
