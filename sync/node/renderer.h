// What a modality implements. The renderer host (sync/node/run_renderer.h) owns the loop and calls these functions, all
// of them from the thread of the loop.
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
#include "sync/assets/scene_exchange.h"
#include "sync/text/settings.h"
#include "sync/time/time.h"

namespace tactus::sync {

// What NODE_HEALTH reports of a tick.
struct Status {
  std::int8_t state = node_health_t::RUNNING;
  std::string note = "";
  int quality = 0, qualities = 0;  // step of its quality ladder, 0: full, and the number of steps; 0 of 0: it has none
};

// What a renderer makes of a scene.
struct Loaded {
  int tool = -1;                  // index in scene_t.tools; -1: none
  double rate_Hz = 0;             // of its ticks from now on; 0: as before
  Nanoseconds output_latency{0};  // from the arrival of an event to its output, at the most
  Status status{.state = node_health_t::WAITING};
};

class Renderer {
 public:
  virtual ~Renderer() = default;

  // A scene is complete. Reading that takes long runs in a thread of its own (Opening); step() polls it.
  virtual Loaded begin_scene(const SceneReceiver& scenes) = 0;
  // Throws std::invalid_argument with one sentence; then nothing has changed.
  virtual void change_setting(const std::string& name, const std::string& value) = 0;
  // One tick: takes in the messages that arrived, renders, publishes, reports. Nothing: there is nothing to render yet.
  virtual std::optional<Status> step(HostTime now) = 0;

  // The user has closed its window.
  virtual bool closed() { return false; }
  // The log is over: its files get their names. Returns what came of it, in lines. Throws std::runtime_error with one
  // sentence when nothing did.
  virtual std::string finish_log(HostTime /*clock*/) { return ""; }
  // The loop has ended.
  virtual void finish() {}
};

// The settings of a command line alone. Throws std::runtime_error with one sentence for the first that does not fit.
template <class Settings>
Settings settings_of(std::span<const SettingField<Settings>> fields, const std::string& node,
                     const std::vector<std::string>& set) {
  Settings settings;
  const auto refused = apply_settings(settings, fields, node, std::vector<setting_t>{}, set);
  if (!refused.empty()) throw std::runtime_error(refused.front());
  return settings;
}

// A renderer with a table of settings (settings.csv). It keeps the order of their sources: the defaults, then the scene,
// then the command line, then what is asked for over the bus.
template <class Settings>
class SettingsRenderer : public Renderer {
 public:
  using Fields = std::span<const SettingField<Settings>>;

  Loaded begin_scene(const SceneReceiver& scenes) final {
    Settings settings;
    for (const std::string& refused : apply_settings(settings, fields_, host_.descriptor().name,
                                                     scenes.scene()->settings, host_.options().set))
      host_.print(refused);
    settings_ = own_ = std::move(settings);
    return load(scenes, settings_);
  }
  // Limits that protect a person stay within those of scene and command line.
  void change_setting(const std::string& name, const std::string& value) final {
    Settings changed = settings_;
    change_live(changed, own_, fields_, name, value);
    change(changed, name);
    settings_ = std::move(changed);
  }

 protected:
  // Throws std::runtime_error with one sentence when a setting of the command line does not fit.
  SettingsRenderer(RendererHost& host, Fields fields)
      : host_(host), fields_(fields), settings_(settings_of(fields, host.descriptor().name, host.options().set)),
        own_(settings_) {}
  virtual Loaded load(const SceneReceiver& scenes, const Settings& settings) = 0;
  // The setting `name` changes. Throws std::invalid_argument with one sentence; then nothing has changed.
  virtual void change(const Settings& /*settings*/, const std::string& /*name*/) {}

  RendererHost& host() const { return host_; }
  const Settings& settings() const { return settings_; }

 private:
  RendererHost& host_;
  Fields fields_;
  Settings settings_, own_;
};

}  // namespace tactus::sync
