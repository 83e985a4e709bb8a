#include "sim_node/scene/extensions/tactus_maps.h"

#include <tactus/map_def_t.hpp>

#include "sim_node/all_settings.gen.h"
#include "sim_node/scene/sdf/attributes.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxMaps = 64;
constexpr double kMax = 1e9;

struct Name {
  std::string node, rest;
};

// "node.rest"
Name split(const LoadContext& context, const sdf::Element& element, const std::string& text, const char* attribute) {
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == text.size() || text.size() > 112)
    context.reject(element, "has " + std::string(attribute) + "=\"" + text + "\": write NODE.NAME");
  return {text.substr(0, dot), text.substr(dot + 1)};
}

// A process has the settings of its node folder: "haptic_node_lamp" those of haptic_node.
const sync::SettingRow& row_of(const LoadContext& context, const sdf::Element& element, const Name& to) {
  std::string numbers;
  bool known = false;
  for (const NodeSettingRow& r : kAllSettings) {
    if (to.node != r.node && !to.node.starts_with(std::string(r.node) + "_")) continue;
    known = true;
    const std::string_view unit = r.row.unit;
    const bool number = unit != "bool" && unit != "text" && unit.find('|') == std::string_view::npos;
    if (!r.row.live || !number) continue;
    if (to.rest == r.row.name) return r.row;
    numbers += (numbers.empty() ? "" : ", ") + std::string(r.row.name);
  }
  const std::string what = "drives \"" + to.node + "." + to.rest + "\", ";
  if (!known) context.reject(element, what + "and there is no such node");
  context.reject(element, what + "which is not a number that can be changed while " + to.node + " runs" +
                              (numbers.empty() ? "" : "; such are " + numbers));
}

map_def_t read_map(const LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  map_def_t map{};
  map.tag = attributes.required_text("from");
  map.setting = attributes.required_text("to");
  split(context, element, map.tag, "from");
  const auto to = split(context, element, map.setting, "to");
  const sync::SettingRow& row = row_of(context, element, to);
  map.gain = attributes.quantity("gain", "1", -kMax, kMax).value_or(1);
  const std::string unit = std::string_view(row.unit) == "count" ? "1" : row.unit;
  const double initial = sync::parse_quantity(row.initial, unit);
  const std::string_view safety = row.safety;
  // A map must not drive a safety limit beyond its default.
  const double low = safety == "min" ? initial : row.min, high = safety == "max" ? initial : row.max;
  map.offset = attributes.quantity("offset", unit, -kMax, kMax).value_or(0);
  map.low = attributes.quantity("low", unit, low, high).value_or(low);
  map.high = attributes.quantity("high", unit, low, high).value_or(high);
  attributes.done();
  if (map.low > map.high) context.reject(element, "has a low above its high: exchange them");
  return map;
}

}  // namespace

void read_maps(LoadContext& context, const sdf::Element& world) {
  for (const sdf::Element& element : world.children("tactus:map")) {
    if (context.world.maps.size() >= kMaxMaps)
      context.reject(element, "is one too many: a scene has at most " + std::to_string(kMaxMaps) + " maps");
    context.world.maps.push_back(read_map(context, element));
  }
}

}  // namespace tactus::sim
