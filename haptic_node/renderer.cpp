#include "haptic_node/renderer.h"

#include <algorithm>
#include <thread>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/rendering/tagged.h"
#include "lcmtypes/pointing.h"
#include "sync/time/phases.h"
#include "sync/node/realtime.h"
#include "sync/assets/scene_pictures.h"
#include "sync/text/error_text.h"

namespace tactus::haptic {

void Options::add_to(sync::Arguments& app) {
  app.add_option("--tool", tool, "tool that the hand holds; default: the scene's first");
  app.add_option(
      "--device", device,
      "virtual_hand, virtual_hand:FILE, playback:FILE[,scale=S][,offset=X/Y/Z][,rate=R], "
      "spidar:NAME|FILE.json[,offset=X/Y/Z] or external:NAME[,offset=X/Y/Z]; default: the device of the scene");
  log.add_to(app, "force", "haptic.csv");
  app.option("--trace").excludes("--device");
}

void Options::parse_device() {
  if (!device.empty()) device_spec = std::make_shared<DeviceSpec>(parse_device_spec(device));
}

NodeRenderer::NodeRenderer(sync::RendererHost& host, const Options& options, Offline* log)
    : SettingsRenderer(host, setting_fields()),
      tool_name_(options.tool),
      device_spec_(options.device_spec),
      log_(log),
      device_states_(host.bus().queue<device_state_t>(channels::kDeviceState, 64)),
      device_forces_(host.bus().queue<device_force_t>(channels::kDeviceForce, 64)),
      touch_(host.endpoint().delayed_snapshots<touch_model_t>(channels::kTouchModel, 1024)),
      events_(host.endpoint().events()),
      safety_(safety_limits(settings())),
      quality_(settings()) {
  touch_.on_arrival([this](const touch_model_t& page, sync::HostTime arrival) {
    if (session_) session_->observe_arrival(page, arrival);
  });
  tag(host.node().tags(), published_);
  host.node().set_state(node_health_t::WAITING, "waits for the scene");
}

sync::LoadedScene NodeRenderer::load(const sync::SceneReceiver& scenes, const Settings& settings) {
  scene_ = scenes.scene();
  config_ = resolve_config(*scene_, settings, tool_name_);
  if (session_) session_->end();
  start_loading(scenes);
  if (log_) log_->follow(config_.tool);
  host().print_status(config_.tool >= 0 ? limits_sentence(settings) : config_.problem);
  const auto is_pointer = [&](const tool_def_t& tool) { return only_points(tool, scene_->lights); };
  is_pointer_ = config_.tool >= 0 && is_pointer(scene_->tools[static_cast<std::size_t>(config_.tool)]);
  only_pointers_ = std::all_of(scene_->tools.begin(), scene_->tools.end(), is_pointer);
  quality_ = Quality(settings);
  return {.tool = config_.tool,
          .rate_Hz = settings.rate_Hz,
          .output_latency = sync::from_seconds(1 / settings.rate_Hz),
          .status = {.state = config_.tool >= 0 ? node_health_t::WAITING : node_health_t::READY,
                     .text = config_.tool >= 0 ? "waits for its device" : config_.problem}};
}

void NodeRenderer::start_loading(const sync::SceneReceiver& scenes) {
  device_task_.reset();
  maps_.reset();
  maps_task_.emplace([scene = *scene_, pictures = sync::pictures_of(scenes)] {
    sync::leave_realtime();
    return std::make_unique<SurfaceMaps>(read_maps(scene, pictures));
  });
  if (config_.tool < 0) return;
  device_task_.emplace([scene = *scene_, config = config_, spec = device_spec_, log = log_] {
    sync::leave_realtime();
    return log ? log->device() : make_tool_device(scene, config, spec.get());
  });
}

void NodeRenderer::finish_loading() {
  // A log waits for both; the live loop never waits.
  while (log_ && ((maps_task_ && !maps_task_->done()) || (device_task_ && !device_task_->done())))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (maps_task_ && maps_task_->done()) {
    maps_ = maps_task_->take();
    maps_task_.reset();
    if (!maps_->error.empty()) host().print_status(maps_->error);
    if (session_ && !session_->ended()) session_->set_maps(maps_);
  }
  if (device_task_ && device_task_->done()) start_session();
}

void NodeRenderer::start_session() {
  try {
    session_.emplace(*scene_, config_, device_task_->take(), host().bus().clocks(), safety_);
    if (maps_) session_->set_maps(maps_);
  } catch (const std::exception& e) {
    const std::string reason = sync::error_text(e);
    host().print_status(reason);
    host().node().set_state(node_health_t::OUTPUT_LOST, reason);
  }
  device_task_.reset();
}

void NodeRenderer::apply_setting(const Settings& settings, const std::string&) {
  if (!session_)
    throw std::invalid_argument("it has no scene yet, so no setting can change; wait until it is ready");
  config_.settings = settings;
  session_->change(settings);
}

void NodeRenderer::receive() {
  while (auto m = touch_.pop())
    if (session_) session_->push(std::move(m->message), m->arrival);
  // The simulation publishes events when they are due, so all received events are due. Until the first touch model they wait in
  // the inbox, which discards them when the simulation restarts.
  if (!session_ || session_->has_touch_model()) {
    const auto due = events_.inbox().take(sync::SimTime::max());
    if (session_) session_->push(due);
  }
  while (const auto m = device_states_.pop())
    if (session_) session_->push(m->message, m->arrival);
  // Commands of other nodes of this run; a replayed log commands no device.
  const sync::Identity& me = host().bus().identity();
  while (const auto m = device_forces_.pop())
    if (session_ && m->message.header.incarnation != me.incarnation && m->message.header.run_id == me.run_id)
      session_->push(m->message, m->arrival);
}

std::optional<sync::Status> NodeRenderer::step(sync::HostTime now) {
  const bool in_tick = !log_ || log_->begin_tick(now);
  finish_loading();
  receive();
  if (!session_ || !in_tick) return std::nullopt;
  TickOutput& out = render(now);
  if (session_->ended()) return std::nullopt;
  publish(now, out);
  for (const presentation_t& report : out.reports) host().report(report);
  if (host().live()) quality_.add(host().clock() - now);
  return status(now);
}

TickOutput& NodeRenderer::render(sync::HostTime now) {
  const sync::ScopedPhaseTimer rendering(sync::Phase::kRender);
  const sync::ModalityEndpoint& endpoint = host().endpoint();
  return session_->step(now,
                        {.delay = endpoint.delay(),
                         .touch_delay = endpoint.profile_delay(),
                         .force_step_N = endpoint.output().value("force_step"),
                         .touch_arrival = only_pointers_ ? std::optional(now) : std::nullopt},
                        quality_.planes());
}

void NodeRenderer::publish(sync::HostTime now, TickOutput& out) {
  if (log_) log_->add(out.state);
  host().bus().publish(channels::kToolState, out.state);
  if (host().node().tags().requested()) published_ = out.state;
  // The force of a tick that was held up belongs to a pose from before. The next tick begins from zero.
  const bool late = host().live() && host().clock() - now > Device::kWatchdog;
  device_force_t* const force = late ? nullptr : session_->force_message();
  if (force) host().bus().publish(channels::kDeviceForce, *force);
}

sync::Status NodeRenderer::status(sync::HostTime now) const {
  sync::Status s{.quality = quality_.step(), .qualities = Quality::steps()};
  if (session_->device_lost()) {
    s.state = node_health_t::OUTPUT_LOST;
    const std::string reason = session_->device_text(now);
    s.text = (reason.empty() ? "the device does not answer" : reason) + ": the force is zero";
  } else if (is_pointer_) {
    s.text = "the tool is a pointer and does not touch";
  } else if (session_->has_touch_model() && session_->lost()) {
    s.state = node_health_t::INPUT_LOST;
    s.text = "no touch model: the force is zero";
  } else if (session_->has_touch_model()) {
    s.text = maps_ ? maps_->error : "reads the maps of its surfaces";
    if (s.text.empty()) s.text = session_->device_text(now);
  } else if (!maps_) {
    s.state = node_health_t::WAITING;
    s.text = "reads the maps of its surfaces";
  } else {
    s.state = node_health_t::READY;
    s.text = "waits for a touch model";
  }
  return s;
}

}  // namespace tactus::haptic
