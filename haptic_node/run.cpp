// haptic_node: renders the contact force on the hand, at 1 kHz, one process per device.
//
//   in   TOUCH_MODEL                   the surfaces near its tool, newest only
//        CONTACT_EVENTS                begins and hits of its tool
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: tools, their paths, materials, pictures of relief and friction
//        DEVICE_STATE, DEVICE_FORCE    of an external device; commands of other nodes to it: two commanders lose it
//        SETTING                       changes of its settings during the run
//   out  TOOL_STATE, DEVICE_FORCE      every tick; the force goes to an external device
//        SETTING_REPLY, PRESENTED      each change of a setting; each begin and hit of its tool
//
// When TOUCH_MODEL or the device is lost, the force fades to zero and the health reports it. When CONTACT_EVENTS
// is lost, the contact force remains and the hit transients are missing. The loop never waits for another node.
// With --log it renders a recorded run instead of the bus, as fast as it can, and writes --trace; the device is
// where TOOL_STATE recorded it. The same log gives the same bytes.
#include "haptic_node/run.h"

#include <tactus/node_health_t.hpp>

#include "haptic_node/renderer.h"
#include "sync/degradation/known_modalities.h"
#include "sync/node/run_renderer.h"

using namespace tactus;

namespace {

const sync::NodeDescriptor kHaptic{.name = "haptic_node",
                                   .modality = "haptic",
                                   .expected_events = int{node_health_t::EXPECTS_BEGIN} | node_health_t::EXPECTS_HIT | node_health_t::EXPECTS_OWN_TOOL_ONLY,
                                   .rate_Hz = haptic::Settings{}.rate_Hz,
                                   .fifo_priority = 60,
                                   .about = "Renders the contact force on the hand.",
                                   .inputs = {channels::kTouchModel, channels::kContactEvents},
                                   .presentation_instant = "the tick whose force presents it",
                                   .late_rule = haptic::kLatePolicy,
                                   .output_operators = sync::output_operators_of("haptic")};

class Factory : public sync::RendererFactory {
  void add_options(sync::Arguments& app) override { options_.add_to(app); }
  sync::OfflineInput* prepare(const sync::NodeOptions& options) override {
    sync::settings_of(haptic::setting_fields(), kHaptic.name, options.set);
    options_.parse_device();
    if (options_.log.log.empty()) return nullptr;
    log_ = std::make_unique<haptic::Offline>(options_.log, kHaptic.rate_Hz, sync::host_now());
    return &log_->run();
  }
  std::unique_ptr<sync::Renderer> make(sync::RendererHost& host) override {
    return std::make_unique<haptic::NodeRenderer>(host, options_, log_.get());
  }
  haptic::Options options_;
  std::unique_ptr<haptic::Offline> log_;
};

}  // namespace

int tactus::haptic::run(int argc, char** argv) {
  Factory factory;
  return sync::run_renderer(kHaptic, factory, argc, argv);
}
