// The thermal renderer of the node: from the contacts of one tool to the command of its display.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/contact_frame_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>

#include "sync/node/offline.h"
#include "sync/node/renderer.h"
#include "sync/resampling/contact_stream.h"
#include "thermal_node/devices/device.h"
#include "thermal_node/devices/dose_file.h"
#include "thermal_node/devices/node_config.h"
#include "thermal_node/display/quality.h"
#include "thermal_node/display/ticks.h"
#include "thermal_node/rendering/renderer.h"
#include "thermal_node/skin/dwell.h"

namespace tactus::thermal {

class NodeRenderer : public sync::SettingsRenderer<Settings> {
 public:
  // tool_name: from the command line; empty: the setting, otherwise the first tool of the scene. log: null:
  // renders the bus. exposure: file for the exposure of the skin; empty: default_dose_file().
  NodeRenderer(sync::RendererHost& host, std::string tool_name, sync::OfflineTable* log,
               const std::string& exposure);

  std::optional<sync::Status> step(sync::HostTime now) override;
  std::string finish_log(sync::HostTime clock) override { return log_->result(config_.problem, clock); }

 private:
  sync::LoadedScene load(const sync::SceneReceiver& scenes, const Settings& settings) override;
  void apply_setting(const Settings& settings, const std::string& name) override;
  void receive();
  void render(sync::HostTime now);
  // Reason why the display cannot be relied on, one sentence; null: none.
  const char* display_problem(sync::HostTime now) const;
  // The same for the user, also from the readings; null: the display follows.
  const char* display_trouble() const;
  void store_dose(sync::HostTime now);
  sync::Status status() const;
  void add_tags();

  std::string tool_name_;
  sync::OfflineTable* log_;
  sync::ModalityEndpoint::Events& events_;
  sync::ModalityEndpoint::Stream<contact_frame_t>& frames_;
  sync::Queue<thermal_device_t>& device_messages_;
  sync::Queue<thermal_state_t> commands_{channels::kThermalState, 64};  // of all senders, also of this process
  sync::ContactStream stream_;
  NodeConfig config_;
  Ticks ticks_;
  Quality quality_;
  std::optional<thermal::Renderer> renderer_;
  DwellAccount account_;                 // exposure of the skin, kept across scenes
  std::unique_ptr<DoseFile> dose_file_;  // and across restarts; null: a log is rendered
  std::unique_ptr<Device> device_;
  std::int64_t displays_ = 0;                         // see Device::displays
  sync::HostTime other_command_{}, other_reading_{};  // last message of another program for its display
  std::optional<double> command_degC_;                // last command, kept across scenes
  std::optional<double> plate_degC_;                  // last measurement
  const char* problem_ = nullptr;                     // of the display in the last tick
  std::string dose_problem_;                          // last printed
  thermal_state_t published_{};                       // the latest published state, for the tags
};

}  // namespace tactus::thermal
