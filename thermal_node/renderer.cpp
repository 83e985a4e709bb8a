#include "thermal_node/renderer.h"

#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <utility>

#include "sync/log/export_csv.h"
#include "sync/time/phases.h"
#include "thermal_node/devices/external.h"
#include "thermal_node/devices/make_device.h"
#include "thermal_node/skin/thickness.h"

namespace tactus::thermal {

NodeRenderer::NodeRenderer(sync::RendererHost& host, std::string tool_name, sync::OfflineTable* log)
    : SettingsRenderer(host, setting_fields()),
      tool_name_(std::move(tool_name)),
      log_(log),
      events_(host.endpoint().events()),
      frames_(host.endpoint().snapshots<contact_frame_t>(channels::kContacts, 4096)),
      device_messages_(host.bus().queue<thermal_device_t>(channels::kThermalDevice, 64)),
      stream_(events_.inbox()),
      quality_(Settings{}) {
  add_tags();
  host.node().set_state(node_health_t::WAITING, "waits for the scene");
}

void NodeRenderer::add_tags() {
  sync::Tags& tags = host().node().tags();
  tags.add("skin", "degC", &published_.skin_degC);
  tags.add("command", "degC", &published_.commanded_degC);
  tags.add("plate", "degC", [this] { return plate_degC_.value_or(published_.commanded_degC); });
  tags.add("flux", "W/m2", &published_.heat_flux_W_m2);
  tags.add("force", "N", &published_.force_N);
}

sync::LoadedScene NodeRenderer::load(const sync::SceneReceiver& scenes, const Settings& settings) {
  const scene_t& scene = *scenes.scene();
  config_ = resolve_config(scene, settings, tool_name_);
  if (log_) log_->run().require_rate(settings.rate_Hz);
  quality_ = Quality(settings);
  if (renderer_) dwell_ = renderer_->dwell();
  renderer_.reset();
  device_ = make_device(settings, config_.tool, plate_degC_.value_or(settings.skin_rest_degC));
  if (config_.tool >= 0) {
    renderer_.emplace(settings, scene.materials, config_.tool, config_.tool_body, command_degC_,
                      thickness_of_bodies(scene));
    renderer_->resume(dwell_);
  }
  return {.tool = config_.tool,
          .rate_Hz = settings.rate_Hz,
          .output_latency = sync::from_seconds(1 / settings.rate_Hz) + Ticks::kSettle,
          .status = {.state = node_health_t::WAITING, .text = config_.problem}};
}

void NodeRenderer::apply_setting(const Settings& settings, const std::string&) {
  config_.settings = settings;
  if (renderer_) renderer_->change(settings);
}

void NodeRenderer::receive() {
  stream_.extend_history(host().endpoint().delay());
  while (const auto m = frames_.pop()) stream_.push(m->message, m->arrival);
  while (const auto m = device_messages_.pop())
    // Ignores readings of a log that is replayed meanwhile: that plate is not under this finger.
    if (device_ && m->message.header.run_id == host().options().run_id) device_->receive(m->message, m->arrival);
}

std::optional<sync::Status> NodeRenderer::step(sync::HostTime now) {
  receive();
  if (!renderer_) return std::nullopt;
  render(now);
  for (const presentation_t& report : renderer_->reports()) host().report(report);
  if (host().live()) quality_.add(host().clock() - now);
  return status();
}

void NodeRenderer::render(sync::HostTime now) {
  const sync::ModalityEndpoint& endpoint = host().endpoint();
  const Tick tick =
      ticks_.next(stream_, now, endpoint.newest_arrival(), config_.tool, config_.tool_body, endpoint.delay());
  std::optional<sync::ScopedPhaseTimer> rendering(sync::Phase::kRender);
  const double command_degC = command_degC_.value_or(config_.settings.skin_rest_degC);
  const auto plate = device_ ? device_->step(command_degC, renderer_->load_W(), now) : std::nullopt;
  thermal_state_t state = renderer_->step(tick, {.response_s = endpoint.output().value("response"),
                                                 .longest_substep_s = quality_.longest_substep_s(),
                                                 .plate = plate});
  rendering.reset();
  published_ = state;
  command_degC_ = state.commanded_degC;
  device_silent_ = device_ && !plate;
  if (log_) {
    state.header.publish_time_ns = sync::to_ns(log_->run().now());
    log_->add_row(sync::csv_row(state));
  }
  host().bus().publish(channels::kThermalState, state);
  if (plate) plate_degC_ = plate->plate_degC;
  if (plate && device_->simulated() && !log_) {
    thermal_device_t message = to_message(*plate, config_.tool);
    host().bus().publish(channels::kThermalDevice, message);
  }
}

sync::Status NodeRenderer::status() const {
  sync::Status s{.quality = quality_.step(), .qualities = Quality::steps()};
  if (host().endpoint().newest_arrival() == sync::HostTime{}) {
    s.state = node_health_t::READY;
    s.text = "waits for contacts";
  } else if (renderer_->input_lost()) {
    s.state = node_health_t::INPUT_LOST;
    s.text = "no contacts: the command returns to resting skin";
  } else if (device_silent_) {
    s.text = "the display is silent: the plate is assumed to be at its command";
  }
  return s;
}

}  // namespace tactus::thermal
