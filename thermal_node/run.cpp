// thermal_node: renders the temperature of the objects that a tool touches on a Peltier element, at 50 Hz.
//
//   in   CONTACT_EVENTS, CONTACTS      contacts of the tool, their force and duration
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: tools and materials
//        THERMAL_DEVICE                readings of the display, if it sends any
//   out  THERMAL_STATE, THERMAL_DEVICE every tick; the latter of the simulated display
//        PRESENTED                     every begin and hit of its tool
// Lost contacts, lost or false readings, a second sender of either output: the command returns to the temperature of resting
// skin. With --log it renders a recorded run, as fast as it can, and writes --trace; the same log gives the same bytes.
#include "thermal_node/run.h"

#include <tactus/node_health_t.hpp>

#include "sync/degradation/known_modalities.h"
#include "sync/log/export_csv.h"
#include "sync/node/run_renderer.h"
#include "thermal_node/renderer.h"

using namespace tactus;

namespace {

const sync::NodeDescriptor kThermal{.name = "thermal_node",
                                    .modality = "thermal",
                                    .expected_events = int{node_health_t::EXPECTS_BEGIN} | node_health_t::EXPECTS_HIT | node_health_t::EXPECTS_OWN_TOOL_ONLY,
                                    .rate_Hz = thermal::Settings{}.rate_Hz,
                                    .about = "Renders the temperature of the objects that a tool touches.",
                                    .inputs = {channels::kContacts, channels::kContactEvents},
                                    .presentation_instant = "the end of the tick that applies it",
                                    .late_rule = thermal::kLatePolicy,
                                    .output_operators = sync::output_operators_of("thermal"),
                                    .phases = {sync::Phase::kRender}};

class Factory : public sync::RendererFactory {
  void add_options(sync::Arguments& app) override {
    app.add_option("--tool", tool_, "tool to render; default: the setting `tool`, else the first tool of the scene");
    app.add_option("--exposure", exposure_, "file that keeps the exposure of the skin across restarts; default: NODE.dose in --out");
    log_options_.add_to(app, "temperature", "thermal.csv");
  }
  sync::OfflineInput* prepare(const sync::NodeOptions& options) override {
    const auto settings = sync::settings_of(thermal::setting_fields(), kThermal.name, options.set);
    if (options.check && !exposure_.empty()) sync::check_folder_of(exposure_, "--exposure");
    if (log_options_.log.empty()) return nullptr;
    log_ = std::make_unique<sync::OfflineTable>(log_options_, sync::thermal_csv_names(), settings.rate_Hz, sync::host_now());
    return &log_->run();
  }
  std::unique_ptr<sync::Renderer> make(sync::RendererHost& host) override {
    return std::make_unique<thermal::NodeRenderer>(host, tool_, log_.get(), exposure_);
  }
  std::string tool_, exposure_;
  sync::OfflineTableOptions log_options_;
  std::unique_ptr<sync::OfflineTable> log_;
};

}  // namespace

int tactus::thermal::run(int argc, char** argv) {
  Factory factory;
  return sync::run_renderer(kThermal, factory, argc, argv);
}
