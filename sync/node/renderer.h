// The interface that a modality implements. The renderer host (sync/node/run_renderer.h) owns the loop and calls these
// functions, all from the thread of the loop.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/setting_t.hpp>
#include <utility>
#include <vector>

#include "sync/node/renderer_host.h"
#include "sync/assets/scene_receiver.h"
#include "sync/text/settings.h"
#include "sync/time/time.h"

namespace tactus::sync {

// The status that NODE_HEALTH reports for a tick.
struct Status {
  std::int8_t state = node_health_t::RUNNING;
  std::string text = "";
  int quality = 0, qualities = 0;  // step of its quality ladder (0: full) and number of steps; 0 of 0: it has no ladder
};

// The properties of a loaded scene.
struct LoadedScene {
  int tool = -1;                  // index in scene_t.tools; -1: none
  double rate_Hz = 0;             // of its ticks from now on; 0: unchanged
  Nanoseconds output_latency{0};  // maximum time from the arrival of an event to its output
  Status status{.state = node_health_t::WAITING};
};

class Renderer {
 public:
  virtual ~Renderer() = default;

  // A scene is complete. Slow file reads run in a thread of their own (BackgroundTask); step() polls it.
  virtual LoadedScene begin_scene(const SceneReceiver& scenes) = 0;
  // Changes all of these settings. Throws std::invalid_argument with one sentence; then none has changed.
  virtual void change_settings(const SettingList& settings) = 0;
  // One tick: reads the received messages, renders, publishes, reports. nullopt: there is nothing to render yet.
  virtual std::optional<Status> step(HostTime now) = 0;

  // True after the user has closed the window.
  virtual bool closed() { return false; }
  // The log is over: renames the output files to their final names. Returns a summary of the output, in lines. Throws
  // std::runtime_error with one sentence when there is no output.
  virtual std::string finish_log(HostTime /*clock*/) { return ""; }
  // The loop has ended.
  virtual void finish() {}
};

// The settings of a command line alone. Throws std::runtime_error with one sentence for the first invalid one.
template <class Settings>
Settings settings_of(std::span<const SettingField<Settings>> fields, const std::string& node,
                     const std::vector<std::string>& set) {
  Settings settings;
  const auto refused = apply_settings(settings, fields, node, std::vector<setting_t>{}, set);
  if (!refused.empty()) throw std::runtime_error(refused.front());
  return settings;
}

// A renderer with a table of settings (settings.csv). It applies the sources of settings in this order: defaults, scene,
// command line, requests over the bus.
template <class Settings>
class SettingsRenderer : public Renderer {
 public:
  using Fields = std::span<const SettingField<Settings>>;

  LoadedScene begin_scene(const SceneReceiver& scenes) final {
    Settings settings;
    for (const std::string& refused : apply_settings(settings, fields_, host_.descriptor().name,
                                                     scenes.scene()->settings, host_.options().set))
      host_.print(refused);
    settings_ = configured_ = std::move(settings);
    return load(scenes, settings_);
  }
  // A request over the bus cannot exceed the safety limits of scene and command line.
  void change_settings(const SettingList& settings) final {
    change_live_together(settings_, configured_, fields_, settings,
                         [this](const Settings& changed, const std::string& name) { apply_setting(changed, name); });
  }

 protected:
  // Throws std::runtime_error with one sentence when a setting of the command line is invalid.
  SettingsRenderer(RendererHost& host, Fields fields)
      : host_(host), fields_(fields), settings_(settings_of(fields, host.descriptor().name, host.options().set)),
        configured_(settings_) {}
  virtual LoadedScene load(const SceneReceiver& scenes, const Settings& settings) = 0;
  // Applies the changed setting `name`. Throws std::invalid_argument with one sentence; then no setting has changed.
  virtual void apply_setting(const Settings& /*settings*/, const std::string& /*name*/) {}

  RendererHost& host() const { return host_; }
  const Settings& settings() const { return settings_; }

 private:
  RendererHost& host_;
  Fields fields_;
  Settings settings_, configured_;
};

}  // namespace tactus::sync
