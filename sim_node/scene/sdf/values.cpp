#include "sim_node/scene/sdf/values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "lcmtypes/utf8.h"

namespace tactus::sim::sdf {
namespace {

constexpr std::size_t kMaxQuoted = 60;  // characters of a wrong value in a message

std::string quoted(std::string_view text) {
  return "\"" + std::string(first_bytes(text, kMaxQuoted)) + (text.size() > kMaxQuoted ? "..." : "") + "\"";
}

[[noreturn]] void reject_value(const Element& element, const std::string& what) {
  reject(element, "= " + quoted(element.text) + " " + what);
}

// The next word of `rest`, which it removes; empty at the end.
std::string_view next_word(std::string_view& rest) {
  rest = trimmed(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t\n\r\f\v"));
  rest.remove_prefix(word.size());
  return word;
}

// Whether the word is a number as a whole, within the range of its type.
template <typename Number>
bool parse(std::string_view word, Number& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data(), end, value);
  return at == end && error == std::errc{};
}

// The numbers of the text, at most N; returns their count, or N + 1 when there are more.
template <typename Number, std::size_t N>
std::size_t numbers_of(const Element& element, std::array<Number, N>& values) {
  std::string_view rest = element.text;
  std::size_t count = 0;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    if (count == N) return N + 1;
    if (!parse(word, values[count]) || !std::isfinite(values[count]))
      reject_value(element, "must have finite numbers only, but " + quoted(word) + " is not one");
    ++count;
  }
  return count;
}

template <std::size_t N>
std::array<double, N> exactly(const Element& element) {
  std::array<double, N> values{};
  if (numbers_of(element, values) != N) reject_value(element, "must be " + std::to_string(N) + " numbers");
  return values;
}

bool same_word(std::string_view text, std::string_view word) {
  return std::equal(text.begin(), text.end(), word.begin(), word.end(), [](unsigned char a, unsigned char b) {
    return std::tolower(a) == b;
  });
}

Pose pose_of_quaternion(const Element& pose, const std::array<double, 7>& v) {
  Rotation q{v[6], v[3], v[4], v[5]};
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(norm > 1e-6 && std::isfinite(norm))) reject_value(pose, "has a quaternion without direction: its norm must be 1");
  if (std::abs(norm - 1) > 1e-9) q.w /= norm, q.x /= norm, q.y /= norm, q.z /= norm;
  return {{v[0], v[1], v[2]}, q};
}

}  // namespace

double number_or_infinity(const Element& element) {
  double value = 0;
  if (!parse(element.text, value) || std::isnan(value)) reject_value(element, "must be a number");
  return value;
}

double number(const Element& element) {
  const double value = number_or_infinity(element);
  if (!std::isfinite(value)) reject_value(element, "must be a finite number");
  return value;
}

double child_number(const Element* element, std::string_view child_name, double missing) {
  const Element* child = child_of(element, child_name);
  return child ? number(*child) : missing;
}

std::optional<bool> parse_flag(std::string_view text) {
  if (text == "1" || same_word(text, "true")) return true;
  if (text == "0" || same_word(text, "false")) return false;
  return std::nullopt;
}

bool flag(const Element& element) {
  const auto value = parse_flag(element.text);
  if (!value) reject_value(element, "must be true or false");
  return *value;
}

bool attribute_flag(const Element& element, std::string_view name) {
  const auto value = parse_flag(trimmed(element.value(name, "false")));
  if (!value) reject(element, "has " + std::string(name) + "=" + quoted(element.value(name)) + ": it must be true or false");
  return *value;
}

bool child_flag(const Element* element, std::string_view child_name, bool missing) {
  const Element* child = child_of(element, child_name);
  return child ? flag(*child) : missing;
}

Eigen::Vector2d vector2(const Element& element) { return Eigen::Vector2d(exactly<2>(element).data()); }

Eigen::Vector3d vector3(const Element& element) { return Eigen::Vector3d(exactly<3>(element).data()); }

Eigen::Vector3d child_vector3(const Element* element, std::string_view child_name, const Eigen::Vector3d& missing) {
  const Element* child = child_of(element, child_name);
  return child ? vector3(*child) : missing;
}

Colour colour(const Element& element) {
  std::array<float, 4> c{0, 0, 0, 1};
  const std::size_t count = numbers_of(element, c);
  if ((count != 3 && count != 4) || std::any_of(c.begin(), c.end(), [](float v) { return v < 0 || v > 1; }))
    reject_value(element, "must be a colour: three or four numbers of 0 to 1");
  return {Eigen::Vector3f(c[0], c[1], c[2]).cast<double>(), static_cast<double>(c[3])};
}

std::optional<Colour> child_colour(const Element* element, std::string_view child_name) {
  const Element* child = child_of(element, child_name);
  return child ? std::optional(colour(*child)) : std::nullopt;
}

Pose raw_pose(const Element& pose) {
  const std::string_view format = pose.value("rotation_format", "euler_rpy");
  const bool degrees = attribute_flag(pose, "degrees");
  if (format != "euler_rpy" && format != "quat_xyzw")
    reject(pose, "has rotation_format=" + quoted(format) + ": it must be euler_rpy or quat_xyzw");
  if (format == "quat_xyzw" && degrees) reject(pose, "has degrees for a quaternion: remove degrees");
  if (pose.text.empty()) return {};
  if (format == "quat_xyzw") return pose_of_quaternion(pose, exactly<7>(pose));
  const auto v = exactly<6>(pose);
  // As IGN_DTOR: the product first.
  const auto rad = [&](double angle) { return degrees ? angle * std::numbers::pi / 180 : angle; };
  return {{v[0], v[1], v[2]}, Rotation::from_euler(rad(v[3]), rad(v[4]), rad(v[5]))};
}

Pose child_pose(const Element& element) {
  const Element* pose = element.child("pose");
  return pose ? raw_pose(*pose) : Pose{};
}

}  // namespace tactus::sim::sdf
