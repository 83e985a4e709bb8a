// What every message holds, by name, for programs that show any of it: the types as their .lcm files describe
// them, and the value that a path names in the bytes of a message. Made from the files when Tactus is built.
//
//   force_N.z             a field of a field
//   inputs[0].age_ns      of the first of a list
//   events.count, page    whole numbers are numbers too; a string is text
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
  std::string_view count;    // of a list: the field before it that holds its length, or a number; else empty
  std::string_view comment;  // meaning, unit, frame, sign, range
};
struct MessageType {
  std::string_view name;
  std::int64_t fingerprint;  // with which its bytes begin
  std::span<const Field> fields;
};
struct Channel {
  std::string_view name, type;
};
std::span<const MessageType> message_types();
std::span<const Channel> channel_types();
// Null when there is none.
const MessageType* message_type(std::string_view name);
const MessageType* message_type(std::int64_t fingerprint);
const MessageType* type_on(std::string_view channel);
// Of a message, by its first bytes.
const MessageType* type_of(std::span<const std::uint8_t> bytes);

// A number or text of a message type: where it lies is found in each message, since lists and strings vary in
// length.
class FieldPath {
 public:
  // Throws std::invalid_argument with one sentence that gives the names that are nearest.
  FieldPath(const MessageType& type, std::string_view path);

  // Nothing when the bytes are no whole message of the type, or its list is not that long. Whatever they are,
  // nothing beyond them is read, and it takes no longer than they are long.
  std::optional<std::variant<double, std::string>> read(std::span<const std::uint8_t> bytes) const;
  // Of a number only.
  std::optional<double> number(std::span<const std::uint8_t> bytes) const;
  bool is_text() const { return last_->type == "string"; }
  const Field& field() const { return *last_; }
  // As the names of the path tell it, from the last to the first: "force_N.z" is in N. Empty: they do not.
  std::string unit() const;

 private:
  struct Step {
    std::size_t field;  // of the type it is in
    std::int64_t index;
  };
  const MessageType* type_;
  std::vector<Step> steps_;
  const Field* last_ = nullptr;
  std::string path_;
};

// Calls visit(path, field, value) for every number and text of a message, in the order of its fields; the path as FieldPath
// takes it. False when the bytes are no whole message of the type: what was visited until then is what they hold.
using Leaf = std::variant<std::int64_t, double, std::string>;
bool for_each_leaf(const MessageType& type, std::span<const std::uint8_t> bytes,
                   const std::function<void(const std::string& path, const Field& field, const Leaf& value)>& visit);

// The unit that ends a name: "force_N" N, "heat_flux_W_m2" W/m2, "age_ns" ns; empty: none.
std::string unit_of(std::string_view name);
// As the names of a path tell it, from the last to the first: that of "force_N.z" is N.
std::string unit_of_path(std::string_view path);

}  // namespace tactus
