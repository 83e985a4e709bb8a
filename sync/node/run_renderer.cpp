#include "sync/node/run_renderer.h"

#include <iostream>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <utility>

#include "sync/node/live_settings.h"
#include "sync/sandbox/sandbox.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {
namespace {

constexpr const char* kConflict = "two simulations send; the first one counts, stop the other";

// One run of a renderer.
class RendererRun {
 public:
  RendererRun(const NodeDescriptor& descriptor, const NodeOptions& options, RendererFactory& factory, OfflineInput* log)
      : log_(log), node_(descriptor, options), scenes_(node_.bus()), endpoint_(node_), ticks_(node_, log),
        host_(node_, endpoint_, ticks_), renderer_(factory.make(host_)), live_(node_) {
    // In virtual time all nodes are one process, and the simulation reports it.
    if (const std::string notice = confinement_notice(available_confinement()); !notice.empty() && !VirtualTime::current()) host_.print_status(notice);
    if (log_) endpoint_.set_report_listener([this](const presentation_t& r) { log_->record_outcome(node_.descriptor().modality, r); });
  }

  void loop() {
    while (node_.running() && !ticks_.over() && !renderer_->closed()) {
      const HostTime now = ticks_.next();
      endpoint_.step(now);
      if (scenes_.poll(now)) load();
      change_settings(now);
      if (const std::optional<Status> status = renderer_->step(now)) {
        endpoint_.publish(ticks_.now());
        report_status(*status);
      }
      show_progress();
    }
    if (log_) host_.print_status(renderer_->finish_log(host_now()));
    renderer_->finish();
  }

 private:
  void load() {
    live_.set_scene(*scenes_.scene());
    const LoadedScene loaded = renderer_->begin_scene(scenes_);
    if (loaded.rate_Hz > 0) node_.set_rate(loaded.rate_Hz);
    node_.set_tool(loaded.tool);
    endpoint_.set_scene(*scenes_.scene(), loaded.tool);
    endpoint_.set_output_latency(loaded.output_latency);
    report_status(loaded.status);
  }
  void change_settings(HostTime now) {
    const auto change = [this](const SettingList& settings) { renderer_->change_settings(settings); };
    for (const std::string& refused : live_.step(now, change)) host_.print_status(refused);
  }
  void report_status(const Status& status) {
    const bool conflict = endpoint_.simulation_conflict(ticks_.now());
    // The world waits for a modality without a scene.
    const bool lacks_scene = !scenes_.scene() && status.state == node_health_t::READY;
    std::string text = lacks_scene ? "waits for the scene" : status.text;
    if (conflict) text += (text.empty() ? "" : "; ") + std::string(kConflict);
    node_.set_state(lacks_scene ? node_health_t::WAITING : status.state, std::move(text));
    if (status.qualities > 0) node_.set_quality(status.quality, status.qualities);
  }
  void show_progress() {
    if (!log_) return;
    if (const auto line = log_->progress(host_now())) host_.print_status(*line);
  }

  OfflineInput* log_;
  Node node_;
  SceneReceiver scenes_;
  ModalityEndpoint endpoint_;
  TickSource ticks_;
  RendererHost host_;
  std::unique_ptr<Renderer> renderer_;
  LiveSettings live_;
};

}  // namespace

void RendererHost::print(const std::string& line) const { std::cerr << line << std::endl; }

int run_renderer(const NodeDescriptor& descriptor, RendererFactory& factory, int argc, char** argv) try {
  Arguments app;
  NodeOptions options;
  options.add_to(app, descriptor);
  factory.add_options(app);
  parse_or_exit(app, descriptor.name, argc, argv);
  OfflineInput* const log = factory.prepare(options);
  if (log) log->adapt(options);
  if (options.check) {
    check_node_files(options);
    return 0;  // not exit(): the factory removes the unfinished files of a log that it opened
  }
  RendererRun(descriptor, options, factory, log).loop();
  return 0;
} catch (const std::exception& e) {
  return fail(descriptor.name, e);
}

}  // namespace tactus::sync
