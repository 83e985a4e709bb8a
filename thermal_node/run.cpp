// thermal_node: renders the temperature of what a tool touches on a Peltier element, at 50 Hz.
//
//   in   CONTACT_EVENTS, CONTACTS      what the tool touches, how firmly and for how long
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: tools and materials
//        THERMAL_DEVICE                what the display says of itself, if it does
//   out  THERMAL_STATE                 every tick
//        THERMAL_DEVICE                every tick, of the simulated display
//        PRESENTED                     every begin and hit of its tool
//
// Losing the display's answers, it is taken to be where it was commanded. Losing the contacts returns the command
// to the temperature of resting skin; the loop never waits for another node. With --log it renders a recorded run
// instead of the bus into --trace, as fast as it can; the same log gives the same bytes.
#include "thermal_node/run.h"

#include <CLI/CLI.hpp>
#include <tactus/node_health_t.hpp>

#include "sync/degradation/known_modalities.h"
#include "sync/node/run_renderer.h"
#include "thermal_node/renderer.h"

using namespace tactus;

namespace {

const sync::NodeDescriptor kThermal{
    .name = "thermal_node",
    .modality = "thermal",
    .expected_events = int{node_health_t::OWES_BEGIN} | node_health_t::OWES_HIT | node_health_t::OWES_OWN_TOOL_ONLY,
    .rate_Hz = thermal::Settings{}.rate_Hz,
    .about = "Renders the temperature of what a tool touches.",
    .inputs = {channels::kContacts, channels::kContactEvents},
    .presentation_instant = "the end of the tick whose heat holds it",
    .late_policy = thermal::kLate,
    .output_operators = sync::output_operators_of("thermal"),
    .phases = {sync::Phase::kRender}};

class Factory : public sync::RendererFactory {
  void add_options(CLI::App& app) override {
    app.add_option("--tool", tool_, "tool whose touch is felt; default: the scene's choice, else its first");
    log_options_.add_to(app);
  }
  sync::Offline* prepare(const sync::NodeOptions& options) override {
    const auto settings = sync::settings_of(thermal::setting_fields(), kThermal.name, options.set);
    log_ = thermal::Offline::open(log_options_, settings.rate_Hz, sync::host_now());
    return log_ ? &log_->run() : nullptr;
  }
  std::unique_ptr<sync::Renderer> make(sync::RendererHost& host) override {
    return std::make_unique<thermal::NodeRenderer>(host, tool_, log_.get());
  }
  std::string tool_;
  thermal::OfflineOptions log_options_;
  std::unique_ptr<thermal::Offline> log_;
};

}  // namespace

int tactus::thermal::run(int argc, char** argv) {
  Factory factory;
  return sync::run_renderer(kThermal, factory, argc, argv);
}
