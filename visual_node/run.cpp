// visual_node: draws the scene, its tools and a flash for every contact, at 60 Hz.
//   in   WORLD_STATE, CONTACT_EVENTS, TOOL_STATE   bodies, contacts and tools; the position of a tracked head
//        SCENE, SETTING, QUESTION                  the scene, changes of settings, questions for a participant
//        PLAYOUT, FRAME_SHOWN                      of a room: its delay, and the frames that other walls have
//        CONTACTS, NODE_HEALTH, others             while an overlay or a plot shows them
//   out  PRESENTED, MEDIA_CLOCK, FRAME_SHOWN       a report for every begin and hit; presentation times of frames
//        SIM_COMMAND, DEVICE_STATE, ANSWER         keys, mouse and gamepad of a window
//        PICTURE_CHUNK                             the picture, when streamed
// Lost WORLD_STATE: bodies are extrapolated for 50 ms, then held, and the picture is marked. --log: renders a log to --video.
#include "visual_node/run.h"

#include <iostream>
#include <tactus/node_health_t.hpp>

#include "sync/degradation/known_modalities.h"
#include "sync/node/run_renderer.h"
#include "visual_node/named_files.h"
#include "visual_node/renderer.h"

using namespace tactus;

namespace {

const sync::NodeDescriptor kVisual{
    .name = "visual_node",
    .modality = "visual",
    .expected_events = int{node_health_t::EXPECTS_BEGIN} | int{node_health_t::EXPECTS_HIT},
    .rate_Hz = visual::Settings{}.rate_Hz,
    .about = "Draws the scene, its tools and a flash for every contact.",
    .inputs = {channels::kWorldState, channels::kContactEvents, channels::kToolState},
    .presentation_instant = "the fence after the frame that first shows it",
    .late_rule = sync::LateRule::kShowNewest,
    .output_operators = sync::output_operators_of("visual"),
    .phases = {sync::Phase::kRender}};

class Factory : public sync::RendererFactory {
  void add_options(sync::Arguments& app) override { options_.add_to(app); }
  sync::OfflineInput* prepare(const sync::NodeOptions& options) override {
    const auto settings = sync::settings_of(visual::setting_fields(), kVisual.name, options.set);
    options_.complete(kVisual.name, options);
    if (options.check) visual::check_named_files(settings);
    log_ = visual::Offline::open(options_.log, settings.rate_Hz, sync::host_now());
    render_output_ = visual::open_render_output(settings, options_);
    std::cerr << options.name << ": " << render_output_->description() << std::endl;
    return log_ ? &log_->run() : nullptr;
  }
  std::unique_ptr<sync::Renderer> make(sync::RendererHost& host) override {
    return std::make_unique<visual::NodeRenderer>(host, *render_output_, options_, log_.get());
  }
  visual::Options options_;
  std::unique_ptr<visual::Offline> log_;
  std::unique_ptr<visual::RenderOutput> render_output_;
};

}  // namespace

int tactus::visual::run(int argc, char** argv) {
  Factory factory;
  return sync::run_renderer(kVisual, factory, argc, argv);
}
