#include "sync/node/setting_maps.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_values_t.hpp>

namespace tactus::sync {

double mapped(const map_def_t& map, double value) {
  return std::clamp(map.offset + map.gain * value, map.low, map.high);
}

void SettingMaps::set(const std::vector<map_def_t>& maps) {
  maps_.clear();
  const std::string prefix = node_ + ".";
  for (const map_def_t& def : maps)
    if (def.setting.starts_with(prefix) && maps_.size() < kMax)
      maps_.push_back({.def = def, .setting = def.setting.substr(prefix.size()), .last_value = {}});
}

tag_request_t SettingMaps::request() const {
  std::set<std::string> sources;
  for (const Map& map : maps_) sources.insert(map.def.tag);
  tag_request_t m{};
  m.header.sim_time_ns = -1;
  // More patterns than fit a message become one request for all variables.
  m.patterns = sources.size() > kMaxPatterns ? std::vector<std::string>{"*"}
                                              : std::vector<std::string>(sources.begin(), sources.end());
  m.pattern_count = static_cast<std::int32_t>(m.patterns.size());
  return m;
}

void SettingMaps::push(const tag_values_t& m) {
  table_.read(m, [&](const TagTable::List& list, const tag_def_t& tag, std::int64_t, double value) {
    const std::size_t dot = list.node.size();
    for (Map& map : maps_)
      if (map.def.tag.size() == dot + 1 + tag.name.size() && map.def.tag.starts_with(list.node) &&
          map.def.tag[dot] == '.' && map.def.tag.ends_with(tag.name))
        map.value = mapped(map.def, value), map.fresh = true;
  });
}

std::vector<SettingMaps::Change> SettingMaps::take_changes(HostTime now) {
  std::vector<Change> changes;
  if (now < next_) return changes;
  next_ = now + kMinInterval;
  for (Map& map : maps_) {
    if (!std::exchange(map.fresh, false)) continue;
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", map.value);
    if (map.last_value == text) continue;
    changes.push_back({map.setting, map.last_value = text});
  }
  return changes;
}

void SettingMaps::disable(const std::string& name) {
  std::erase_if(maps_, [&](const Map& map) { return map.setting == name; });
}

}  // namespace tactus::sync
