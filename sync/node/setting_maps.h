// Settings of a process that tagged variables drive (<tactus:map>), for instance the grip force that dims the picture or the
// speed that raises the volume. Pure.
#pragma once

#include <string>
#include <tactus/map_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <utility>
#include <vector>

#include "sync/node/tag_table.h"
#include "sync/time/time.h"

namespace tactus::sync {

// The value of the setting for a value of the variable.
double mapped(const map_def_t& map, double value);

class SettingMaps {
 public:
  // Minimum interval between changes of a setting: settings are changed by name and as text.
  static constexpr Nanoseconds kMinInterval{10'000'000};
  static constexpr std::size_t kMax = 32;
  static constexpr std::size_t kMaxPatterns = 16;  // of a tag_request_t

  // node: the process that owns the settings.
  explicit SettingMaps(std::string node) : node_(std::move(node)) {}

  // Uses the maps of a scene that drive settings of this process, at most kMax.
  void set(const std::vector<map_def_t>& maps);
  bool any() const { return !maps_.empty(); }
  // The request to publish once a second.
  tag_request_t request() const;
  void push(const tag_list_t& m) { table_.push(m); }
  void push(const tag_values_t& m);

  struct Change {
    std::string name, value;
  };
  // The settings whose variable has changed since they were returned last. A variable without new values leaves its setting
  // unchanged.
  std::vector<Change> take_changes(HostTime now);
  // The setting cannot be changed: its maps are disabled until the next scene.
  void disable(const std::string& name);

 private:
  struct Map {
    map_def_t def;
    std::string setting;
    bool fresh = false;
    double value = 0;
    std::string last_value;  // returned last
  };
  std::string node_;
  std::vector<Map> maps_;
  TagTable table_;
  HostTime next_{};
};

}  // namespace tactus::sync
