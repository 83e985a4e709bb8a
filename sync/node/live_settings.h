// The settings of a node while it runs: what is asked of them over the bus (SETTING), and what the scene's maps
// make of tagged variables. A renderer's main has one and calls step() each tick.
#pragma once

#include <string>
#include <tactus/scene_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <vector>

#include "sync/node/node.h"
#include "sync/node/setting_changes.h"
#include "sync/node/setting_maps.h"

namespace tactus::sync {

class LiveSettings {
 public:
  // Before the node's first tick.
  explicit LiveSettings(Node& node);

  // The maps of a scene hold from now on.
  void set_scene(const scene_t& scene) { maps_.set(scene.maps); }
  // Carries out what is asked, one request a tick, and answers it; then what the maps say. `apply` as for
  // SettingChanges. Returns a sentence for each map that cannot drive its setting: it is said once.
  std::vector<std::string> step(HostTime now, const SettingChanges::Apply& apply);

 private:
  Node& node_;
  Queue<setting_change_t>& asked_;
  RawQueue& lists_;
  RawQueue& values_;
  SettingChanges changes_;
  SettingMaps maps_;
  HostTime ask_next_{};
};

}  // namespace tactus::sync
