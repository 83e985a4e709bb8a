#include "haptic_node/devices/motion_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "lcmtypes/tool_device.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::haptic {
namespace {

// Covers days of seconds and any place on a site; a larger number has another unit.
constexpr double kLargest = 1e6;
constexpr std::size_t kMaxLineLength = 1000;
// Half an hour at 1 kHz (design): a row takes eight times the memory of the shortest line.
constexpr std::size_t kMaxRows = 2'000'000;
constexpr std::string_view kHeader = "time_s,x_m,y_m,z_m";
constexpr std::string_view kHeaderWithPose = "time_s,x_m,y_m,z_m,qw,qx,qy,qz";

[[noreturn]] void reject(const std::string& name, std::size_t line, const std::string& what) {
  throw std::runtime_error("motion file " + name + ", line " + std::to_string(line) + ": " + what);
}

double number(std::string_view field, const std::string& name, std::size_t line) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value) ||
      std::abs(value) > kLargest)
    reject(name, line, "\"" + std::string(field) + "\" is not a valid number; write plain seconds and metres");
  return value;
}

std::vector<double> numbers(std::string_view text, const std::string& name, std::size_t line) {
  std::vector<double> out;
  while (true) {
    const auto comma = text.find(',');
    out.push_back(number(text.substr(0, comma), name, line));
    if (comma == std::string_view::npos) return out;
    text.remove_prefix(comma + 1);
  }
}

void append(Motion& motion, const std::vector<double>& row, const std::string& name, std::size_t line) {
  if (!motion.times_s.empty() && row[0] <= motion.times_s.back())
    reject(name, line, "the time does not increase; sort the rows and remove repeated times");
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  if (row.size() == 8) {
    q = Eigen::Quaterniond(row[4], row[5], row[6], row[7]);
    if (std::abs(q.norm() - 1) > 1e-2)
      reject(name, line, "the quaternion is not of unit length; normalise qw,qx,qy,qz");
    q.normalize();
    if (!motion.orientations.empty() && motion.orientations.back().dot(q) < 0) q.coeffs() *= -1;
  }
  motion.times_s.push_back(row[0]);
  motion.positions_m.emplace_back(row[1], row[2], row[3]);
  motion.orientations.push_back(q);
}

}  // namespace

Motion read_motion(std::istream& in, const std::string& name) {
  std::array<char, kMaxLineLength + 1> buffer{};  // with the end of the string
  std::uintmax_t bytes = 0;
  std::size_t line = 0;
  const auto next = [&](std::string_view& text) {
    ++line;
    in.getline(buffer.data(), buffer.size());
    const auto count = static_cast<std::size_t>(in.gcount());
    if (count == 0) return false;
    if (in.fail())
      reject(name, line,
             "it is longer than " + std::to_string(kMaxLineLength) + " characters; name a motion file");
    if ((bytes += count) > kMaxMotionFileBytes)
      reject(name, line,
             "the file is larger than " + std::to_string(kMaxMotionFileBytes >> 20) + " MiB; shorten it");
    text = buffer.data();
    if (text.size() + (in.eof() ? 0 : 1) != count) reject(name, line, "it has a byte 0, so it is no text; name a motion file");
    if (text.ends_with('\r')) text.remove_suffix(1);
    return true;
  };
  std::string_view text;
  next(text);
  const bool with_pose = text == kHeaderWithPose;
  if (!with_pose && text != kHeader)
    reject(name, 1, "the header must be " + std::string(kHeader) + " or " + std::string(kHeaderWithPose));
  Motion motion;
  const std::size_t columns = with_pose ? 8 : 4;
  while (next(text)) {
    if (text.empty()) continue;
    const auto row = numbers(text, name, line);
    if (row.size() != columns)
      reject(name, line, std::to_string(row.size()) + " columns where the header has " + std::to_string(columns));
    append(motion, row, name, line);
    if (motion.times_s.size() > kMaxRows)
      reject(name, line, "there are more than " + std::to_string(kMaxRows) + " rows; shorten it");
  }
  if (motion.times_s.empty()) reject(name, 2, "there is no row; add at least one");
  return motion;
}

Motion read_motion(const std::string& path) {
  std::string text;
  try {
    text = sync::read_regular_text(path, kMaxMotionFileBytes);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("motion file " + path + " cannot be read: " + e.what() +
                             "; give a CSV file, and check the path and its permissions");
  }
  std::istringstream in(std::move(text));
  return read_motion(in, path);
}

}  // namespace tactus::haptic
