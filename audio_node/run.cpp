// audio_node: renders hits, scrapes and rolls of the scene through a sound card, each on its sample: at the time
// of PLAYOUT, or with its own delay.
//
//   in   CONTACT_EVENTS; CONTACTS (lasting contacts, and the clock map); WORLD_STATE (orientation of bodies); SCENE;
//        TOOL_STATE of a head (position of the ear); PLAYOUT; SETTING (method and recordings take effect)
//   out  PRESENTED, MEDIA_CLOCK, SETTING_REPLY, audio.wav
//
// When CONTACT_EVENTS is lost, sounding bodies decay. When CONTACTS is lost, scrapes and rolls end. When
// WORLD_STATE is lost, bodies keep their orientation. A lost sound card is reported and reopened. The loop never
// waits for another node, and the callback of the card never waits for the loop. With --log it renders a recorded
// run instead of the bus, as fast as it can, and writes --wav; the same log gives the same bytes.
#include "audio_node/run.h"

#include <tactus/node_health_t.hpp>

#include "audio_node/named_files.h"
#include "audio_node/renderer.h"
#include "sync/degradation/known_modalities.h"
#include "sync/node/run_renderer.h"

using namespace tactus;

namespace {

// The loop only forwards events, at a priority below the simulation; the callback of the card renders them at 70.
const sync::NodeDescriptor kAudio{.name = "audio_node",
                                  .modality = "audio",
                                  .expected_events = node_health_t::EXPECTS_HIT,
                                  .rate_Hz = 1000,
                                  .fifo_priority = 45,
                                  .about = "Sounds the hits of the scene through a sound card.",
                                  .inputs = {channels::kContactEvents, channels::kContacts, channels::kWorldState},
                                  .presentation_instant = "the DAC time of its first sample",
                                  .late_rule = audio::kLatePolicy,
                                  .output_operators = sync::output_operators_of("audio"),
                                  .phases = {sync::Phase::kRender}};

class Factory : public sync::RendererFactory {
  void add_options(sync::Arguments& app) override { options_.add_to(app); }
  sync::OfflineInput* prepare(const sync::NodeOptions& options) override {
    const auto settings = sync::settings_of(audio::setting_fields(), kAudio.name, options.set);
    options_.check();
    if (options.check) audio::check_named_files(settings);
    log_ = audio::Offline::open(options_.log, kAudio.rate_Hz, sync::host_now());
    return log_ ? &log_->run() : nullptr;
  }
  std::unique_ptr<sync::Renderer> make(sync::RendererHost& host) override {
    return std::make_unique<audio::NodeRenderer>(host, options_, log_.get());
  }
  audio::Options options_;
  std::unique_ptr<audio::Offline> log_;
};

}  // namespace

int tactus::audio::run(int argc, char** argv) {
  Factory factory;
  return sync::run_renderer(kAudio, factory, argc, argv);
}
