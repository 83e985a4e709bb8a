// lamp_node: a lamp that flashes for every hit, at 100 Hz. When its inputs are lost the flash fades.
//   in   CONTACT_EVENTS, CONTACTS, SCENE       out   PRESENTED of every hit, lamp.csv
//
// A modality outside the source tree of Tactus: it uses the installed target Tactus::sync only. docs/adding_a_modality.md walks through a
// node of the same form.
#include <cmath>
#include <fstream>
#include <map>

#include "modality/settings.gen.h"
#include "sync/node/run_renderer.h"
#include "sync/presentation/late.h"
#include "sync/resampling/contact_stream.h"

using namespace tactus;

namespace {

using Settings = modality::Settings;  // named after the folder of settings.csv

const sync::NodeDescriptor kLamp{.name = "lamp_node",
                                 .modality = "lamp",
                                 .expected_events = node_health_t::EXPECTS_HIT,
                                 .rate_Hz = Settings{}.rate_Hz,
                                 .about = "Flashes a lamp for every hit.",
                                 .inputs = {channels::kContactEvents, channels::kContacts},
                                 .presentation_instant = "the tick whose command begins the flash",
                                 .output_operators = {{"response", "s", 1e-3, 60, "time constant of the lamp"}}};

struct LampRenderer : sync::SettingsRenderer<Settings> {
  explicit LampRenderer(sync::RendererHost& host) : SettingsRenderer(host, modality::setting_fields()) { table << "host_ns,brightness\n"; }

  sync::LoadedScene load(const sync::SceneReceiver&, const Settings& s) override {
    return {.rate_Hz = s.rate_Hz, .output_latency = sync::from_seconds(1 / s.rate_Hz)};
  }

  std::optional<sync::Status> step(sync::HostTime now) override {
    while (const auto m = frames.pop()) contacts.push(m->message, m->arrival);
    const auto map = contacts.map(now);
    if (!map) return sync::Status{node_health_t::READY, "waits for contacts"};
    for (const contact_event_t& e : contacts.take_events(sync::SimTime::max()))
      if (e.kind == contact_event_t::HIT) due.emplace(host().endpoint().schedule(e.event_id, map->to_host(sync::sim_time(e.time_ns))), e);
    flash *= std::exp(-1 / (settings().rate_Hz * settings().fade_time_s));
    for (; !due.empty() && due.begin()->first <= now; due.erase(due.begin())) present(due.begin()->second, due.begin()->first, now);
    const double response_s = host().endpoint().output().value("response");
    brightness += (response_s > 0 ? 1 - std::exp(-1 / (settings().rate_Hz * response_s)) : 1) * (flash - brightness);
    table << sync::to_ns(now) << "," << brightness << "\n";  // command the lamp here
    return sync::Status{};
  }

  void present(const contact_event_t& hit, sync::HostTime scheduled, sync::HostTime now) {
    flash = std::fmin(1, flash + hit.approach_speed_m_s / settings().full_hit_m_s);
    const sync::LatePolicy late{sync::LateRule::kShowNewest, sync::from_seconds(settings().late_after_s), sync::from_seconds(10)};
    host().report({hit.event_id, presentation_t::WHOLE, -1, sync::to_ns(scheduled), sync::to_ns(now),
                   sync::from_seconds(0.5 / settings().rate_Hz).count(), late.outcome(now - scheduled)});
  }

  sync::ModalityEndpoint::Stream<contact_frame_t>& frames = host().endpoint().snapshots<contact_frame_t>(channels::kContacts, 4096);
  sync::ContactStream contacts{host().endpoint().events().inbox()};
  std::multimap<sync::HostTime, contact_event_t> due;
  double flash = 0, brightness = 0;  // 0 .. 1: of the hits, and as commanded
  std::ofstream table{host().options().out + "/lamp.csv"};
};

}  // namespace

int main(int argc, char** argv) {
  sync::PlainFactory<LampRenderer> factory;
  return sync::run_renderer(kLamp, factory, argc, argv);
}
