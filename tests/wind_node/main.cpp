// wind_node: a fan that blows a gust for every hit, at 50 Hz. When its inputs are lost the gust decays.
//   in   CONTACT_EVENTS, CONTACTS, SCENE       out   PRESENTED of every hit, wind.csv
#include <fstream>
#include <map>

#include "sync/resampling/contact_stream.h"
#include "sync/node/run_renderer.h"
#include "tests/wind_node/fan.h"

using namespace tactus;

const sync::NodeDescriptor kWind{
    .name = "wind_node", .modality = "wind",
    .expected_events = node_health_t::EXPECTS_HIT,
    .rate_Hz = wind::Settings{}.rate_Hz,
    .about = "Blows a gust for every hit.",
    .inputs = {channels::kContactEvents, channels::kContacts},
    .presentation_instant = "the tick whose command begins the gust",
    .output_operators = {{"response", "s", 1e-3, 60, "time constant of the fan"}}};

struct WindRenderer : sync::SettingsRenderer<wind::Settings> {
  explicit WindRenderer(sync::RendererHost& host)
      : SettingsRenderer(host, wind::setting_fields()) { table << "host_ns,gust,fan_share\n"; }
  sync::LoadedScene load(const sync::SceneReceiver&, const wind::Settings& s) override {
    return {.rate_Hz = s.rate_Hz, .output_latency = sync::from_seconds(1 / s.rate_Hz)};
  }
  std::optional<sync::Status> step(sync::HostTime now) override {
    while (const auto m = frames.pop()) contacts.push(m->message, m->arrival);
    const auto map = contacts.map(now);
    if (!map) return sync::Status{node_health_t::READY, "waits for contacts"};
    for (const contact_event_t& e : contacts.take_events(sync::SimTime::max()))
      if (e.kind == contact_event_t::HIT)
        due.emplace(host().endpoint().schedule(e.event_id, map->to_host(sync::sim_time(e.time_ns))), e);
    fan.step(settings(), host().endpoint().output().value("response"));
    for (; !due.empty() && due.begin()->first <= now; due.erase(due.begin()))
      host().report(fan.blow(settings(), due.begin()->second, due.begin()->first, now));
    table << sync::to_ns(now) << "," << fan.gust << "," << fan.share << "\n";
    return sync::Status{};
  }

  sync::ModalityEndpoint::Stream<contact_frame_t>& frames = host().endpoint().snapshots<contact_frame_t>(channels::kContacts, 4096);
  sync::ContactStream contacts{host().endpoint().events().inbox()};
  std::multimap<sync::HostTime, contact_event_t> due;
  wind::Fan fan;
  std::ofstream table{host().options().out + "/wind.csv"};
};

int main(int argc, char** argv) {
  sync::PlainFactory<WindRenderer> factory;
  return sync::run_renderer(kWind, factory, argc, argv);
}
