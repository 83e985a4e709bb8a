#include "thermal_node/renderer.h"

#include <chrono>
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
namespace {

bool recent(sync::HostTime at, sync::HostTime now) {
  return at != sync::HostTime{} && std::chrono::abs(now - at) <= Device::kSilence;
}

}  // namespace

NodeRenderer::NodeRenderer(sync::RendererHost& host, std::string tool_name, sync::OfflineTable* log,
                           const std::string& exposure)
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
  if (log_) return;
  host.bus().attach(commands_);
  const sync::Identity& identity = host.bus().identity();
  dose_file_ = std::make_unique<DoseFile>(
      exposure.empty() ? default_dose_file(host.options().out, identity.node) : exposure, identity.clock);
  account_ = dose_file_->load(host.clock());
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
  if (renderer_) account_ = renderer_->dwell().account();
  renderer_.reset();
  device_ = make_device(settings, config_.tool, plate_degC_.value_or(settings.skin_rest_degC),
                        host().bus().identity().clock);
  displays_ = 0;
  if (config_.tool < 0) command_degC_.reset();  // without commands the plate is neutral
  if (config_.tool >= 0) {
    renderer_.emplace(settings, scene.materials, config_.tool, config_.tool_body, command_degC_,
                      thickness_of_bodies(scene));
    renderer_->resume(account_);
  }
  return {.tool = config_.tool,
          .rate_Hz = settings.rate_Hz,
          .output_latency = sync::from_seconds(1 / settings.rate_Hz) + Ticks::kSettle,
          .status = {.state = config_.tool >= 0 ? node_health_t::WAITING : node_health_t::READY, .text = config_.problem}};
}

void NodeRenderer::apply_setting(const Settings& settings, const std::string&) {
  config_.settings = settings;
  if (renderer_) renderer_->change(settings);
}

void NodeRenderer::receive() {
  stream_.extend_history(host().endpoint().delay());
  while (const auto m = frames_.pop()) stream_.push(m->message, m->arrival);
  while (const auto m = device_messages_.pop()) {
    const thermal_device_t& reading = m->message;
    // Ignores readings of a log that is replayed meanwhile: that plate is not under this finger.
    if (reading.header.run_id != host().options().run_id) continue;
    if (device_) device_->receive(reading, m->arrival);
    const bool own = reading.header.incarnation == host().bus().identity().incarnation;
    if (!log_ && !own && reading.tool == config_.tool && config_.settings.device != "external")
      other_reading_ = m->arrival;
  }
  while (const auto m = commands_.pop()) {
    const header_t& header = m->message.header;
    if (header.run_id == host().options().run_id && header.incarnation != host().bus().identity().incarnation &&
        m->message.tool == config_.tool)
      other_command_ = m->arrival;
  }
}

const char* NodeRenderer::display_problem(sync::HostTime now) const {
  if (log_) return nullptr;
  if (recent(other_command_, now))
    return "two programs send THERMAL_STATE for its tool: the plate is neutral; stop one of them";
  if (recent(other_reading_, now))
    return "another program sends THERMAL_DEVICE for its tool: the plate is neutral; stop it, or set "
           "device=external";
  return device_ ? device_->problem(now) : nullptr;
}

void NodeRenderer::store_dose(sync::HostTime now) {
  if (!dose_file_) return;
  dose_file_->save(renderer_->account_after(DoseFile::kAhead_s), now);
  if (dose_file_->problem() == dose_problem_) return;
  dose_problem_ = dose_file_->problem();
  host().print_status(dose_problem_);
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
      ticks_.next(stream_, now, frames_.newest_arrival(), config_.tool, config_.tool_body, endpoint.delay());
  std::optional<sync::ScopedPhaseTimer> rendering(sync::Phase::kRender);
  const double command_degC = command_degC_.value_or(config_.settings.skin_rest_degC);
  const auto plate = device_ ? device_->step(command_degC, renderer_->load_W(), now) : std::nullopt;
  problem_ = display_problem(now);
  if (device_ && std::exchange(displays_, device_->displays()) != device_->displays())
    renderer_->restart_display();
  thermal_state_t state =
      renderer_->step(tick, {.response_s = endpoint.output().value("response"),
                             .longest_substep_s = quality_.longest_substep_s(),
                             .plate = plate,
                             .display_lost = problem_ != nullptr,
                             .check_following = !log_ || (device_ && device_->simulated()),
                             .plate_return_K_s = device_ ? device_->return_K_s() : kDisplayReturn_K_s});
  rendering.reset();
  store_dose(now);
  published_ = state;
  command_degC_ = state.commanded_degC;
  if (log_) {
    state.header.publish_time_ns = sync::to_ns(log_->run().now());
    log_->add_row(sync::csv_row(state, log_->run().run_number()));
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
  if (frames_.newest_arrival() == sync::HostTime{}) {
    s.state = node_health_t::READY;
    s.text = "waits for contacts";
  } else if (renderer_->input_lost()) {
    s.state = node_health_t::INPUT_LOST;
    s.text = "no contacts: the command returns to resting skin";
  }
  // A display that is not there does not hide the state of the inputs.
  if (const char* trouble = display_trouble()) {
    if (s.state == node_health_t::RUNNING && renderer_->display() != DisplayState::kShort)
      s.state = node_health_t::OUTPUT_LOST;
    s.text = trouble;
  }
  return s;
}

const char* NodeRenderer::display_trouble() const {
  switch (renderer_->display()) {
    case DisplayState::kGood: return nullptr;
    case DisplayState::kShort:
      return "the display reports that it delivers less than commanded: the command stays near its plate";
    case DisplayState::kLost:
      return problem_ ? problem_ : "the display was lost: the plate is neutral for a moment";
    case DisplayState::kFault:
      return "the display reports a fault or an impossible temperature: the plate is neutral; check it";
    case DisplayState::kNotFollowing:
      return "the plate does not follow its command: it stays neutral; check the display and its limits, then "
             "start it again";
  }
  return nullptr;
}

}  // namespace tactus::thermal
