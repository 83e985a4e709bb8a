// Reflection of messages for programs that show any of them: the types with the comments of their .lcm files, and
// access to values by a path. Generated from the .lcm files by the build.
//
//   force_N.z             a field of a field
//   inputs[0].age_ns      of the first element of a list
//   events.count, page    integers are numbers too; a string is text
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus {

struct Field {  // one line of a .lcm file
  std::string_view type, name;
  std::string_view count;    // of a list: the preceding field with its length, or a number; otherwise empty
  std::string_view comment;  // meaning, unit, frame, sign, range
};
struct MessageType {
  std::string_view name;
  std::int64_t fingerprint;  // first 8 bytes of a message
  std::span<const Field> fields;
};
struct Channel {
  std::string_view name, type;
};
std::span<const MessageType> message_types();
std::span<const Channel> channel_types();
// The type with that name, fingerprint or channel; null when there is none.
const MessageType* message_type(std::string_view name);
const MessageType* message_type(std::int64_t fingerprint);
const MessageType* type_on(std::string_view channel);
// The type of a message, by its first bytes.
const MessageType* type_of(std::span<const std::uint8_t> bytes);

// A path to a number or text of a message type. The offset is found in each message, since lists and strings vary
// in length.
class FieldPath {
 public:
  // Throws std::invalid_argument with one sentence that suggests the nearest names.
  FieldPath(const MessageType& type, std::string_view path);

  // Returns nullopt when the bytes are not a complete message of the type, or its list is too short. Never reads
  // beyond the bytes, and takes time linear in their length.
  std::optional<std::variant<double, std::string>> read(std::span<const std::uint8_t> bytes) const;
  // Like read(), but returns nullopt for text.
  std::optional<double> number(std::span<const std::uint8_t> bytes) const;
  bool is_text() const { return last_->type == "string"; }
  const Field& field() const { return *last_; }
  // The unit from the names of the path, searched from the last to the first: that of "force_N.z" is N. Empty:
  // none.
  std::string unit() const;

 private:
  struct Step {
    std::size_t field;  // index within its type
    std::int64_t index;
  };
  const MessageType* type_;
  std::vector<Step> steps_;
  const Field* last_ = nullptr;
  std::string path_;
};

// Calls visit(path, field, value) for every number and text of a message, in the order of its fields; FieldPath
// accepts the path. Returns false when the bytes are not a complete message of the type, after a visit of the
// intact part.
using Leaf = std::variant<std::int64_t, double, std::string>;
bool for_each_leaf(const MessageType& type, std::span<const std::uint8_t> bytes,
                   const std::function<void(const std::string& path, const Field& field, const Leaf& value)>& visit);

// The unit suffix of a name: "force_N" N, "heat_flux_W_m2" W/m2, "age_ns" ns; empty: none.
std::string unit_of(std::string_view name);
// The unit of a path, from its names from the last to the first: that of "force_N.z" is N.
std::string unit_of_path(std::string_view path);

}  // namespace tactus
