// The haptic renderer of the node: one tool with its device, over all scenes of a run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/offline.h"
#include "haptic_node/rendering/quality.h"
#include "haptic_node/rendering/session.h"
#include "sync/node/renderer.h"
#include "sync/node/background_task.h"

namespace tactus::haptic {

// Command-line options of this node; every node has further common options.
struct Options {
  std::string tool;    // empty: the first tool of the scene
  std::string device;  // empty: the device that the scene specifies
  std::shared_ptr<const DeviceSpec> device_spec;
  sync::OfflineTableOptions log;

  void add_to(sync::Arguments& app);
  // Fills device_spec. Throws std::runtime_error with one sentence when there is no such device.
  void parse_device();
};

class NodeRenderer : public sync::SettingsRenderer<Settings> {
 public:
  // log: null: renders the bus.
  NodeRenderer(sync::RendererHost& host, const Options& options, Offline* log);

  std::optional<sync::Status> step(sync::HostTime now) override;
  std::string finish_log(sync::HostTime clock) override { return log_->result(config_.problem, clock); }

 private:
  sync::LoadedScene load(const sync::SceneReceiver& scenes, const Settings& settings) override;
  void apply_setting(const Settings& settings, const std::string& name) override;
  void start_loading(const sync::SceneReceiver& scenes);
  void finish_loading();
  void start_session();
  void receive();
  TickOutput& render(sync::HostTime now);
  void publish(sync::HostTime now, TickOutput& out);
  sync::Status status(sync::HostTime now) const;

  std::string tool_name_;
  std::shared_ptr<const DeviceSpec> device_spec_;
  Offline* log_;
  sync::Queue<device_state_t>& device_states_;
  sync::Queue<device_force_t>& device_forces_;
  sync::ModalityEndpoint::Stream<touch_model_t>& touch_;
  sync::ModalityEndpoint::Events& events_;
  // Stages of touch of a profile: `force` acts here, `action` in the simulation.
  sync::ModalityEndpoint::Stage &force_stage_, &action_stage_;
  Safety safety_;  // shared by all scenes
  NodeConfig config_;
  Quality quality_;
  const scene_t* scene_ = nullptr;
  // Opened on background threads. The surfaces are smooth until the maps are ready.
  std::optional<sync::BackgroundTask<Device>> device_task_;
  std::optional<sync::BackgroundTask<SurfaceMaps>> maps_task_;
  std::shared_ptr<const SurfaceMaps> maps_;
  std::optional<Session> session_;
  bool is_pointer_ = false;     // the tool is a pointer or the head, and needs no touch model
  bool only_pointers_ = false;  // all tools of the scene are such: no touch model marks the start of the path
  tool_state_t published_{};  // the latest published state, for the tags
};

}  // namespace tactus::haptic
