// The modality of touch on the renderer host: one tool with its device, from one scene to the next.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/contact_events_t.hpp>
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

// What the command line says, beside the options of every node.
struct Options {
  std::string tool;    // empty: the scene's first
  std::string device;  // empty: as the scene says
  std::shared_ptr<const DeviceSpec> device_spec;
  OfflineOptions log;

  void add_to(CLI::App& app);
  // Fills device_spec. Throws std::runtime_error with one sentence when there is no such device.
  void parse_device();
};

class NodeRenderer : public sync::SettingsRenderer<Settings> {
 public:
  // log: null: it renders the bus.
  NodeRenderer(sync::RendererHost& host, const Options& options, Offline* log);

  std::optional<sync::Status> step(sync::HostTime now) override;
  std::string finish_log(sync::HostTime clock) override { return log_->result(choice_.problem, clock); }

 private:
  sync::Loaded load(const sync::SceneReceiver& scenes, const Settings& settings) override;
  void change(const Settings& settings, const std::string& name) override;
  void begin_to_open(const sync::SceneReceiver& scenes);
  void finish_opening();
  void take_device();
  void receive();
  TickOutput& render(sync::HostTime now);
  void publish(TickOutput& out);
  sync::Status status() const;

  std::string tool_name_;
  std::shared_ptr<const DeviceSpec> device_given_;
  Offline* log_;
  sync::Queue<device_state_t>& device_states_;
  sync::Queue<device_force_t>& device_forces_;
  sync::ModalityEndpoint::Stream<touch_model_t>& touch_;
  sync::ModalityEndpoint::Stream<contact_events_t>& events_;
  Safety safety_;  // one for all scenes
  NodeConfig choice_;
  Quality quality_;
  const scene_t* scene_ = nullptr;
  // Read in threads of their own. Until the maps are there the surfaces are smooth.
  std::optional<sync::BackgroundTask<Device>> opening_device_;
  std::optional<sync::BackgroundTask<SurfaceMaps>> opening_maps_;
  std::shared_ptr<const SurfaceMaps> maps_;
  std::optional<Session> session_;
  bool points_ = false;    // its tool is a wand or the head: it waits for no touch model
  bool no_touch_ = false;  // so are all tools of the scene: no touch model marks the beginning of the world
  tool_state_t published_{};  // the newest, for the tags
};

}  // namespace tactus::haptic
