// The settings of a node: a struct with defaults (generated from its settings.csv) and the table that sets its members by
// name, from the scene or from the command line.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::sync {

// Parses a number with a unit into the given base unit: ("20ms", "s") -> 0.02, ("1.5 kHz", "Hz") -> 1500. A number without
// unit is taken in the base unit; profiles refuse it (sync/degradation/parse_operator.cpp). A temperature and a difference of
// temperatures are both in degC; K is refused there. Throws std::invalid_argument with one sentence.
double parse_quantity(std::string_view text, std::string_view unit);

// One row of a settings.csv.
struct SettingRow {
  const char* name;     // as in XML and --set
  const char* unit;     // "s", "Hz", "N/m", "1", "count", "bool", or "a|b|c" for a choice; "p:*" in it stands for any word after p:
  const char* initial;  // the default, in that unit
  double min;
  double max;
  const char* meaning;
  const char* source;
  // Safety limit for persons: "max", an upper one, or "min", a lower one. A scene may only tighten it. "": none.
  const char* safety = "";
  bool live = false;  // may be changed while the node runs
};

// Checks a value against its row. Throws std::invalid_argument with one sentence that names the setting and its range.
void check_setting(const SettingRow& row, std::string_view value);

// The same for a value from a scene: a value that loosens a safety limit beyond its default is refused, too.
void check_scene_setting(const SettingRow& row, std::string_view value);

template <class Settings>
struct SettingField {
  SettingRow row;
  std::variant<double Settings::*, int Settings::*, bool Settings::*, std::string Settings::*> field;
};

// Sets one setting by name, if `check` accepts it. Throws std::invalid_argument when the name is unknown or the value is
// invalid.
template <class Settings>
void set(Settings& settings, std::span<const SettingField<Settings>> table, std::string_view name,
         std::string_view value, void (*check)(const SettingRow&, std::string_view) = check_setting) {
  for (const auto& entry : table) {
    if (name != entry.row.name) continue;
    check(entry.row, value);
    std::visit(
        [&](auto field) {
          using Value = std::remove_reference_t<decltype(settings.*field)>;
          if constexpr (std::is_same_v<Value, std::string>)
            settings.*field = std::string(value);
          else if constexpr (std::is_same_v<Value, bool>)
            settings.*field = value == "true" || value == "1";
          else
            settings.*field = static_cast<Value>(parse_quantity(value, std::string_view(entry.row.unit) == "count" ? "1" : entry.row.unit));
        },
        entry.field);
    return;
  }
  throw std::invalid_argument("there is no setting \"" + std::string(name) + "\"");
}

// Changes one setting of a running node. Any program can request it over the bus, so a safety limit may not become looser
// than its default, nor than `own`, the value from scene and command line. Throws std::invalid_argument with one sentence;
// then nothing has changed.
template <class Settings>
void change_live(Settings& settings, const Settings& own, std::span<const SettingField<Settings>> table,
                 std::string_view name, std::string_view value) {
  std::string live;
  for (const auto& entry : table) {
    if (entry.row.live) live += (live.empty() ? "" : ", ") + std::string(entry.row.name);
    if (!entry.row.live || name != entry.row.name) continue;
    Settings changed = settings;
    set(changed, table, name, value, check_scene_setting);
    if (const auto limit = std::get_if<double Settings::*>(&entry.field); limit && *entry.row.safety) {
      const double past = changed.**limit - own.**limit;
      if (std::string_view(entry.row.safety) == "max" ? past > 0 : past < 0)
        throw std::invalid_argument("setting " + std::string(name) +
                                    " protects a person: it may not be looser than in the scene and on the command line");
    }
    settings = std::move(changed);
    return;
  }
  throw std::invalid_argument(
      live.empty() ? "none of its settings can be changed while it runs"
                   : "setting \"" + std::string(name) + "\" cannot be changed while it runs; these settings can: " + live);
}

using SettingList = std::vector<std::pair<std::string, std::string>>;  // {name, value}, in the order of their change

// Changes several settings of a running node, all or none. apply(settings, name) makes a changed setting effective; it may
// throw std::invalid_argument, and then the earlier ones get their old values again. Throws std::invalid_argument with one
// sentence; then nothing has changed.
template <class Settings, class Apply>
void change_live_together(Settings& settings, const Settings& own, std::span<const SettingField<Settings>> table,
                          const SettingList& changes, const Apply& apply) {
  Settings changed = settings;
  for (const auto& [name, value] : changes) change_live(changed, own, table, name, value);
  std::size_t applied = 0;
  try {
    for (; applied < changes.size(); ++applied) apply(changed, changes[applied].first);
  } catch (const std::invalid_argument&) {
    while (applied-- > 0) apply(settings, changes[applied].first);
    throw;
  }
  settings = std::move(changed);
}

// Applies the settings of a scene for `node` (a list of {node, name, value}), then those of the command line ("name=value").
// Any program can send a scene, so only the command line may loosen a safety limit. Returns one sentence per refused entry;
// the others are applied.
template <class Settings, class SceneSettings>
std::vector<std::string> apply_settings(Settings& settings, std::span<const SettingField<Settings>> table,
                                        std::string_view node, const SceneSettings& from_scene,
                                        const std::vector<std::string>& from_command_line) {
  std::vector<std::string> refused;
  const auto try_set = [&](std::string_view name, std::string_view value, auto check) {
    try {
      set(settings, table, name, value, check);
    } catch (const std::invalid_argument& e) {
      refused.push_back(std::string(node) + ": " + e.what());
    }
  };
  for (const auto& s : from_scene)
    if (s.node == node) try_set(s.name, s.value, check_scene_setting);
  for (const std::string& s : from_command_line) {
    const auto equals = s.find('=');
    try_set(s.substr(0, equals), equals == std::string::npos ? "" : s.substr(equals + 1), check_setting);
  }
  return refused;
}

}  // namespace tactus::sync
