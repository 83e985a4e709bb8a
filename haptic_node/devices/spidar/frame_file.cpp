#include "haptic_node/devices/spidar/frame_file.h"

#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sync/sandbox/regular_file.h"

namespace tactus::haptic {
namespace {

using nlohmann::json;
constexpr std::uintmax_t kMaxBytes = 64 << 10;

[[noreturn]] void reject(const std::string& name, const std::string& what) {
  throw std::runtime_error("string frame " + name + ": " + what);
}

Eigen::Vector3d place(const json& value, const std::string& field, const std::string& name) {
  if (!value.is_array() || value.size() != 3 || !value[0].is_number() || !value[1].is_number() ||
      !value[2].is_number())
    reject(name, "write \"" + field + "\" as [x, y, z] in metres");
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

StringEnds string_ends(const json& value, const std::string& name) {
  if (!value.is_object() || !value.contains("anchor_m")) reject(name, "every string needs its \"anchor_m\"");
  StringEnds ends{place(value["anchor_m"], "anchor_m", name), Eigen::Vector3d::Zero()};
  for (const auto& [field, content] : value.items()) {
    if (field == "knot_m")
      ends.knot_m = place(content, field, name);
    else if (field != "anchor_m")
      reject(name, "a string has no \"" + field + "\"; use anchor_m and knot_m");
  }
  return ends;
}

}  // namespace

StringFrame parse_frame(const std::string& text, const std::string& name) {
  const json file = json::parse(text, nullptr, false);
  if (!file.is_object()) reject(name, "it is not a JSON object; see haptic_node/devices/README.md for one");
  StringFrame f;
  f.name = name;
  std::map<std::string, double*> wanted = {
      {"min_tension_N", &f.min_tension_N},          {"max_tension_N", &f.max_tension_N},
      {"encoder_step_m", &f.encoder_step_m},        {"winding_speed_m_s", &f.winding_speed_m_s},
      {"tension_time_s", &f.tension_time_s},        {"workspace_radius_m", &f.workspace_radius_m},
      {"workspace_tilt_rad", &f.workspace_tilt_rad}};
  for (const auto& [field, content] : file.items()) {
    if (field == "strings") {
      if (!content.is_array() || content.size() > kMaxStrings)
        reject(name, "\"strings\" is not a list of four or eight");
      for (const json& s : content) f.strings.push_back(string_ends(s, name));
      continue;
    }
    const auto number = wanted.find(field);
    if (number == wanted.end()) reject(name, "there is no field \"" + field + "\"");
    if (!content.is_number()) reject(name, "\"" + field + "\" is not a number");
    *number->second = content.get<double>();
    wanted.erase(number);
  }
  if (f.strings.size() != 8) wanted.erase("workspace_tilt_rad");
  if (!wanted.empty()) reject(name, "it lacks \"" + wanted.begin()->first + "\"");
  check_frame(f);
  return f;
}

StringFrame read_frame(const std::string& path) {
  std::string text;
  try {
    text = sync::read_regular_text(path, kMaxBytes);
  } catch (const std::runtime_error& e) {
    reject(path, std::string(e.what()) + "; give a JSON file, which is a regular file of at most 64 kB");
  }
  return parse_frame(text, path);
}

}  // namespace tactus::haptic
