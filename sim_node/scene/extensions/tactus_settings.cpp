#include "sim_node/scene/extensions/tactus_settings.h"

#include <algorithm>
#include <stdexcept>
#include <tactus/setting_t.hpp>

#include "sim_node/all_settings.gen.h"

namespace tactus::sim {
namespace {

constexpr std::string_view kPrefix = "tactus:";

void check(const LoadContext& context, const sdf::Element& element, const setting_t& setting) {
  const auto row = std::find_if(kAllSettings.begin(), kAllSettings.end(), [&](const NodeSettingRow& r) {
    return setting.node == r.node && setting.name == r.row.name;
  });
  if (row == kAllSettings.end())
    context.reject(element,
                   "has no setting \"" + setting.name + "\": docs/settings.md lists those of " + setting.node);
  try {
    sync::check_scene_setting(row->row, setting.value);
  } catch (const std::invalid_argument& e) {
    context.reject(element, std::string("is invalid: ") + e.what());
  }
}

}  // namespace

bool is_setting_element(std::string_view name) { return name.starts_with(kPrefix) && name.ends_with("_node"); }

void read_settings(LoadContext& context, const sdf::Element& world) {
  for (const sdf::Element& element : world.children()) {
    if (!is_setting_element(element.name)) continue;
    const std::string node(element.name.substr(kPrefix.size()));
    const bool known = std::any_of(kAllSettings.begin(), kAllSettings.end(),
                                   [&](const NodeSettingRow& row) { return node == row.node; });
    if (!known) context.warn(element, "is of a node that is not in this build: passed on unchecked");
    for (const sdf::Attribute& attribute : element.attributes) {
      if (attribute.name.starts_with("xmlns")) continue;
      setting_t setting{};
      setting.node = node;
      setting.name = attribute.name;
      setting.value = attribute.value;
      if (known) check(context, element, setting);
      context.world.settings.push_back(setting);
    }
  }
}

}  // namespace tactus::sim
