// The settings of a running node: changes requested over the bus (SETTING), and settings that the maps of the scene drive
// from tagged variables. The main function of a renderer owns one and calls step() each tick.
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
  // Construct it before the first tick of the node.
  explicit LiveSettings(Node& node);

  // Uses the maps of this scene from now on.
  void set_scene(const scene_t& scene) { maps_.set(scene.maps); }
  // Carries out and answers at most one request a tick, then applies the maps. `apply` as for SettingChanges. Returns one
  // sentence for each map that cannot drive its setting, once per map.
  std::vector<std::string> step(HostTime now, const SettingChanges::Apply& apply);

 private:
  Node& node_;
  Queue<setting_change_t>& requests_;
  RawQueue& lists_;
  RawQueue& values_;
  SettingChanges changes_;
  SettingMaps maps_;
  HostTime next_request_{};
};

}  // namespace tactus::sync
