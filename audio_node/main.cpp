// audio_node: sounds the hits of the scene through a sound card, each at a constant delay after its event.
//
//   in   CONTACT_EVENTS; CONTACTS (its clock only); SCENE
//   out  PRESENTED, MEDIA_CLOCK, audio.wav
//
// Losing CONTACT_EVENTS lets what sounds die away; losing the sound card is reported, and the card is tried again.
// The loop never waits for another node, the card's callback never for the loop.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "audio_node/impact.h"
#include "audio_node/mesh_extent.h"
#include "audio_node/output.h"
#include "sync/contact_stream.h"
#include "sync/node.h"
#include "sync/presentation_reporter.h"
#include "sync/scene_exchange.h"

using namespace tactus;

namespace {

// The loop only hands events on, below the simulation; the card's callback renders them at 70.
const sync::Declaration kAudio{"audio_node", "audio", node_health_t::OWES_HIT,
                               1000,         45,      "Sounds the hits of the scene through a sound card."};
constexpr int kCallbackPriority = 70;
constexpr sync::Nanoseconds kOpenAnyway{2'000'000'000};  // the scene may choose the card, but need not come
constexpr sync::Nanoseconds kInputLost{300'000'000};     // snapshots of contacts come at 60 Hz
constexpr sync::Nanoseconds kEarly{20'000'000};          // events of the next moments, should a map run behind

void publish_pair(sync::Bus& bus, const std::string& medium, const audio::MediaPair& pair) {
  media_clock_t m{};
  m.header.sim_time_ns = -1;
  m.medium = medium;
  m.index = pair.index;
  m.host_time_ns = pair.host_ns;
  m.reason = static_cast<std::int8_t>(pair.reason);
  bus.publish(channels::kMediaClock, m);
}

}  // namespace

int main(int argc, char** argv) try {
  sync::NodeOptions options;
  std::string device;
  CLI::App app;
  options.add_to(app, kAudio);
  app.add_option("--audio-device", device, "sound card: default, virtual, or part of its name");
  sync::parse_or_exit(app, kAudio.node, argc, argv);

  audio::Settings checked;
  const auto refused =
      sync::apply_settings(checked, audio::setting_fields(), kAudio.node, std::vector<setting_t>{}, options.set);
  if (!refused.empty()) throw std::runtime_error(refused.front());

  sync::Node node(kAudio, options);
  sync::SceneReceiver scene(node.bus());
  auto& events = node.bus().queue<contact_events_t>(channels::kContactEvents, 4096);
  auto& frames = node.bus().queue<contact_frame_t>(channels::kContacts, 4096);
  sync::ContactStream contacts(node.bus().clocks());
  sync::PresentationReporter reporter(kAudio.modality);
  audio::Output output(options.out, device, kCallbackPriority);
  std::unique_ptr<audio::Impacts> impacts;
  std::int64_t scenes = 0;

  // What a scene has wrong keeps its default and is said once.
  const auto configure = [&](const std::vector<setting_t>& from_scene) {
    audio::Settings settings;
    for (const std::string& refused :
         sync::apply_settings(settings, audio::setting_fields(), kAudio.node, from_scene, options.set))
      std::cerr << refused << std::endl;
    output.configure(settings);
  };
  const auto mesh = [&](std::int64_t hash) -> std::optional<audio::Extent> {
    const sync::Asset* asset = scene.asset(hash);
    const auto m = asset ? sync::decode_asset<mesh_t>(asset->bytes) : std::nullopt;
    return m ? audio::extent_of(*m) : std::nullopt;
  };
  configure({});
  const sync::HostTime started = sync::host_now();

  while (node.running()) {
    const sync::HostTime now = node.wait();
    if (scene.poll(now)) {
      configure(scene.scene()->settings);
      impacts = std::make_unique<audio::Impacts>(*scene.scene(), mesh, output.settings(),
                                                 output.settings().sample_rate_Hz, ++scenes);
    }
    const bool plays = (impacts || now - started > kOpenAnyway) && output.keep_open(now);
    while (const auto m = events.pop()) contacts.push(m->message, m->arrival);
    while (const auto m = frames.pop()) contacts.push(m->message, m->arrival);

    if (const auto map = contacts.map(now); map && impacts) {
      for (const contact_event_t& event : contacts.take_events(map->to_sim(now + kEarly))) {
        if (event.kind != contact_event_t::HIT) continue;
        const auto scheduled = map->to_host(sync::sim_time(event.time_ns)) +
                               sync::from_seconds(output.settings().presentation_delay_s);
        if (!output.submit(impacts->strike(event, scheduled)))
          reporter.report(event.event_id, presentation_t::WHOLE, scheduled, sync::host_time(-1),
                          sync::Nanoseconds(0), presentation_t::DROPPED_LATE);
      }
    }
    while (const auto report = output.next_report()) {
      reporter.report(*report);
      node.count_rendered(report->presented_ns >= 0 ? 1 : 0);
    }
    while (const auto pair = output.next_pair()) publish_pair(node.bus(), output.medium(), *pair);
    reporter.publish(node.bus(), now);
    if (const auto news = output.news()) std::cerr << kAudio.node << ": " << *news << std::endl;

    const sync::HostTime heard = std::max(events.count().newest_arrival, frames.count().newest_arrival);
    node.set_state(!impacts                   ? node_health_t::WAITING
                   : !plays                   ? node_health_t::OUTPUT_LOST
                   : now - heard > kInputLost ? node_health_t::INPUT_LOST
                                              : node_health_t::RUNNING,
                   output.note());
    node.override_ticks(output.callbacks(), output.underflows(), output.callback_rate_Hz());
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("audio_node", e);
}
