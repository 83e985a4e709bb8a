// audio_node: sounds what hits, scrapes and rolls in the scene through a sound card, each on its sample: when PLAYOUT
// says, else at a delay of its own.
//
//   in   CONTACT_EVENTS; CONTACTS (what slides, and its clock); WORLD_STATE, how bodies lie; SCENE;
//        TOOL_STATE of a head, where the ear is; PLAYOUT; SETTING, of which method and recordings are followed
//   out  PRESENTED, MEDIA_CLOCK, SETTING_REPLY, audio.wav
//
// Losing CONTACT_EVENTS lets what sounds die away, losing CONTACTS ends what scrapes and rolls, losing WORLD_STATE leaves bodies turned as they
// were; losing the sound card is reported, and the card is tried again. The loop never waits for another node, the card's
// callback never for the loop. With --log it hears a recorded run instead of the bus and plays it into --wav, as fast as it
// can; the same log gives the same bytes.
#include "audio_node/run.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <thread>

#include "audio_node/devices/file_output.h"
#include "audio_node/excitation/due_hits.h"
#include "audio_node/spatial/ear.h"
#include "audio_node/excitation/impact.h"
#include "audio_node/excitation/mesh_extent.h"
#include "audio_node/offline.h"
#include "audio_node/devices/output.h"
#include "audio_node/excitation/sampler.h"
#include "audio_node/excitation/sliding.h"
#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/node/live_settings.h"
#include "sync/node/node.h"
#include "sync/node/background_task.h"
#include "sync/assets/scene_exchange.h"
#include "sync/node/modality_endpoint.h"
#include "sync/virtual_time/virtual_time.h"

using namespace tactus;

namespace {

// The loop only hands events on, below the simulation; the card's callback renders them at 70.
const sync::NodeDescriptor kAudio{.node = "audio_node",
                               .modality = "audio",
                               .owes = node_health_t::OWES_HIT,
                               .rate_Hz = 1000,
                               .fifo_priority = 45,
                               .about = "Sounds the hits of the scene through a sound card.",
                               .inputs = {channels::kContactEvents, channels::kContacts, channels::kWorldState},
                               .presents = "the DAC time of its first sample",
                               .late = audio::kLate,
                               .degradable = {"dropout"},
                               .phases = {sync::Phase::kRender}};
constexpr int kCallbackPriority = 70;
constexpr sync::Nanoseconds kOpenAnyway{2'000'000'000};  // the scene may choose the card, but need not come
constexpr sync::Nanoseconds kInputLost{300'000'000};     // snapshots of contacts come at 60 Hz
constexpr sync::Nanoseconds kContactsLost{100'000'000};  // six of them
constexpr sync::Nanoseconds kScrapeLead{2'000'000};      // before the callback needs it: two ticks
// Design: half a tick; a blow takes up to 0.3 ms to prepare. Those that come together wait for the next ticks.
constexpr sync::Nanoseconds kStrikesFor{500'000};
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

int tactus::audio::run(int argc, char** argv) try {
  sync::NodeOptions options;
  std::string device;
  bool no_sound = false;
  audio::OfflineOptions of_log;
  CLI::App app;
  options.add_to(app, kAudio);
  app.add_option("--audio-device", device, "sound card: default, virtual, or part of its name");
  app.add_flag("--no-sound", no_sound, "compute no samples, and report when each sound would have begun; only in virtual time");
  of_log.add_to(app, "renders this log of a run", "--wav");
  app.add_option("--wav", of_log.wav, "file for the sound of the log")->needs("--log");
  sync::parse_or_exit(app, kAudio.node, argc, argv);
  if (!of_log.log.empty() && of_log.wav.empty()) throw std::runtime_error("--log needs --wav FILE, which the sound is written to");
  if (no_sound && !sync::VirtualTime::current())
    throw std::runtime_error("--no-sound is for virtual time; live, --audio-device virtual plays into a file and leaves the room quiet");
  std::optional<audio::Offline> offline;
  if (!of_log.log.empty()) {
    offline.emplace(of_log, kAudio.rate_Hz, sync::host_now());
    offline->run().adapt(options);
  }

  audio::Settings checked;
  const auto refused =
      sync::apply_settings(checked, audio::setting_fields(), kAudio.node, std::vector<setting_t>{}, options.set);
  if (!refused.empty()) throw std::runtime_error(refused.front());

  sync::Node node(kAudio, options);
  sync::SceneReceiver scene(node.bus());
  sync::ModalityEndpoint sense(node);
  auto& events = sense.events();
  auto& frames = sense.snapshots<contact_frame_t>(channels::kContacts, 4096);
  auto& world = sense.snapshots<world_state_t>(channels::kWorldState, 4096);
  // Past the profile, which makes events late or rare: where the ear is, is none.
  auto& tools = node.bus().queue<tool_state_t>(channels::kToolState, 512);
  audio::Ear ear(node.bus().clocks());
  sync::ContactStream contacts(node.bus().clocks());
  sync::BodyHistory bodies(node.bus().clocks());
  // Who does not live by the machine's clock plays into a file, and waits for what is read.
  const bool machine_time = !offline && !sync::VirtualTime::current();
  audio::Output output(options.out, device, kCallbackPriority,
                       offline        ? offline->open()
                       : machine_time ? audio::OpenCard{}
                                      : audio::open_files(options.out, no_sound ? "null" : device),
                       no_sound);
  std::unique_ptr<audio::Impacts> impacts;
  std::unique_ptr<audio::Sliding> sliding;
  std::unique_ptr<audio::Sampler> sampler;
  std::optional<sync::BackgroundTask<audio::HeardSurfaces>> surfaces;
  sync::HostTime slid_at{}, told_at{};
  std::int64_t scenes = 0;

  sync::LiveSettings live(node);
  audio::Settings own;  // what scene and command line say
  const auto change = [&](const std::string& name, const std::string& value) {
    audio::Settings changed = output.settings();
    sync::change_live(changed, own, audio::setting_fields(), name, value);
    output.configure(changed);
    if (sampler) sampler->configure(changed);
    if (impacts) impacts->set_gain(changed.gain);
    if (sliding) sliding->set_gain(changed.gain);
  };

  // What a scene has wrong keeps its default and is said once.
  const auto configure = [&](const std::vector<setting_t>& from_scene) {
    audio::Settings settings;
    for (const std::string& refused :
         sync::apply_settings(settings, audio::setting_fields(), kAudio.node, from_scene, options.set))
      std::cerr << refused << std::endl;
    if (!audio::instructions_named(settings.instructions))
      std::cerr << kAudio.node << ": this machine has no " << settings.instructions << " instructions; it computes with "
                << audio::name(audio::available_instructions().back()) << std::endl;
    output.configure(settings);
    own = output.settings();
    sense.set_own_delay(sync::from_seconds(settings.presentation_delay_s));
    sense.set_output_latency(output.latency());
  };
  const auto mesh = [&](std::int64_t hash) -> std::optional<audio::Extent> {
    const sync::Asset* asset = scene.asset(hash);
    const auto m = asset ? sync::decode_asset<mesh_t>(asset->bytes) : std::nullopt;
    return m ? audio::extent_of(*m) : std::nullopt;
  };
  configure({});
  if (offline) sense.tell([&](const presentation_t& report) { offline->run().note(kAudio.modality, report); });
  const sync::HostTime started = offline ? offline->run().feed().begin() : sync::host_now();
  std::int64_t hits = 0, dropped = 0;
  audio::DueHits due;
  const auto drop = [&](const contact_event_t& event, sync::HostTime scheduled) { output.drop(event.event_id, scheduled); };

  node.tags().add("hits", "1", &hits);
  node.tags().add("dropped", "1", &dropped);
  node.tags().add("callbacks", "1", [&] { return static_cast<double>(output.callbacks()); }, 100);
  node.tags().add("underflows", "1", [&] { return static_cast<double>(output.underflows()); }, 100);
  node.tags().add("latency", "s", [&] { return sync::to_seconds(output.latency()); }, 100);

  while (node.running() && !(offline && offline->run().over())) {
    const sync::HostTime now = offline ? offline->run().next(node.bus()) : node.wait();
    sense.step(now);
    if (scene.poll(now)) {
      sense.set_scene(*scene.scene());
      ear.set_scene(*scene.scene());
      due.clear(drop);
      configure(scene.scene()->settings);
      live.set_scene(*scene.scene());
      impacts = std::make_unique<audio::Impacts>(*scene.scene(), mesh, output.settings(),
                                                 output.settings().sample_rate_Hz, ++scenes);
      sampler = std::make_unique<audio::Sampler>(*scene.scene(), output.settings());
      sliding.reset();
      output.hear(nullptr);
      surfaces.emplace([of = *scene.scene(), pictures = sync::pictures_of(scene)] {
        sync::leave_realtime();
        return audio::read_surfaces(of, pictures);
      });
    }
    while (!machine_time && surfaces && !surfaces->done()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (surfaces && surfaces->done()) {
      auto heard = std::make_shared<const audio::HeardSurfaces>();
      try {
        heard = surfaces->take();
      } catch (const std::exception& e) {
        std::cerr << kAudio.node << ": cannot read the maps of the scene (" << e.what() << "); what scrapes sounds without them" << std::endl;
      }
      surfaces.reset();
      output.hear(heard);
      sliding = std::make_unique<audio::Sliding>(*scene.scene(), heard, bodies, *impacts, output.settings(),
                                                 output.settings().sample_rate_Hz);
    }
    // Of scenes that are over: tables of 200 MB take 20 ms to free.
    if (auto unread = output.take_unread(); !unread.empty())
      std::thread([gone = std::move(unread)] { sync::leave_realtime(); }).detach();
    if (auto unread = output.step_library(); !unread.empty())
      std::thread([gone = std::move(unread)] { sync::leave_realtime(); }).detach();
    while (!machine_time && output.library().reading()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      output.step_library();
    }
    if (sampler) sampler->play(output.library().database(), output.library().number());
    for (const std::string& news : live.step(now, change)) std::cerr << kAudio.node << ": " << news << std::endl;
    const bool plays = (impacts || (machine_time && now - started > kOpenAnyway)) && output.keep_open(now);
    output.allow(sense.delay());
    output.degrade({sense.output().dropout_s, sense.output().dropout_every_s});
    if (scene.scene()) output.hear_from(ear.at(now + output.latency()));
    while (const auto m = events.pop()) contacts.push(m->message, m->arrival);
    while (const auto m = frames.pop()) contacts.push(m->message, m->arrival);
    while (const auto m = world.pop()) bodies.push(m->message, m->arrival);
    while (const auto m = tools.pop()) ear.push(m->message, m->arrival);

    if (const auto map = contacts.map(now); map && impacts) {
      for (const contact_event_t& event : contacts.take_events(map->to_sim(now + kEarly))) {
        if (event.kind != contact_event_t::HIT) continue;
        ++hits;
        const sync::HostTime scheduled = sense.schedule(event.event_id, map->to_host(sync::sim_time(event.time_ns)));
        if (!due.push(event, scheduled)) drop(event, scheduled);
      }
    }
    if (impacts && sampler) {
      const sync::ScopedPhaseTimer rendering(sync::Phase::kRender);
      // A log is heard as fast as it can be, however long a tick of it takes.
      const sync::HostTime begun = sync::host_now();
      const auto goes_on = [&] { return !machine_time || sync::host_now() - begun < kStrikesFor; };
      const auto late = audio::late_policy(output.settings().sample_rate_Hz, sync::from_seconds(output.settings().late_limit_s));
      const auto sound = [&](const contact_event_t& event, sync::HostTime scheduled) {
        impacts->hear_from(ear.at(scheduled));
        audio::Strike strike = impacts->strike(event, scheduled, [&](int body) -> std::optional<Eigen::Isometry3d> {
          const auto pose = bodies.pose(body, sync::sim_time(event.time_ns));
          if (pose.status == sync::SampleStatus::kNone) return std::nullopt;
          return Eigen::Translation3d(pose.value.position) * pose.value.orientation;
        });
        sampler->record(strike, event, *impacts);
        output.submit(strike, impacts->table());
      };
      due.handle(now, late, goes_on, sound, drop);
    }
    const sync::Nanoseconds every = output.tell_every(kScrapeLead);
    const bool tells = !no_sound && now - told_at >= every;
    if (sliding) sliding->tell_every(sync::to_seconds(every));
    const bool slides = tells && sliding && sync::to_seconds(now - slid_at) >= sliding->period_s();
    if (const auto map = contacts.map(now); map && sampler && tells && (slides || sampler->plays())) {
      told_at = now;
      sampler->tell_every(sync::to_seconds(every));
      const sync::HostTime heard_at = now + output.latency() + kScrapeLead;
      if (sliding) sliding->hear_from(ear.at(heard_at));
      sampler->hear_from(ear.at(heard_at));
      const sync::SimTime t = map->to_sim(std::min(now, heard_at - sense.delay()));
      contacts.keep(sense.delay());
      bodies.keep(sense.delay());
      // Nobody tells of contacts any more: they would go on for ever.
      const bool told = now - frames.count().newest_arrival < kContactsLost;
      const sync::Contacts lasting = told ? contacts.state_at(t).value : sync::Contacts{};
      for (const audio::RecordedContact& rub : sampler->rubs(lasting, heard_at)) output.submit(rub);
      if (slides)
        for (audio::Scrape scrape : sliding->scrapes(lasting, t, heard_at, sync::to_seconds(now - slid_at))) {
          scrape.slide *= sampler->modal_of(scrape.id, audio::Interaction::kScrape);
          scrape.roll *= sampler->modal_of(scrape.id, audio::Interaction::kRoll);
          output.submit(scrape);
        }
      if (slides) slid_at = now;
    }
    while (const auto report = output.next_report()) {
      sense.report(*report);
      node.count_rendered(report->presented_ns >= 0 ? 1 : 0);
      dropped += report->outcome == presentation_t::DROPPED_LATE || report->outcome == presentation_t::DROPPED_BY_PROFILE;
    }
    while (const auto pair = output.next_pair()) publish_pair(node.bus(), output.medium(), *pair);
    sense.publish(now);
    for (const std::string& news : output.library().news()) std::cerr << kAudio.node << ": " << news << std::endl;
    if (sampler)
      for (const std::string& news : sampler->news()) std::cerr << kAudio.node << ": " << news << std::endl;
    if (offline)
      if (const auto line = offline->run().progress(sync::host_now())) std::cerr << kAudio.node << ": " << *line << std::endl;
    if (const auto news = output.news()) std::cerr << kAudio.node << ": " << *news << std::endl;

    const sync::HostTime heard = std::max(events.count().newest_arrival, frames.count().newest_arrival);
    node.set_state(!impacts                    ? node_health_t::WAITING
                   : !plays                    ? node_health_t::OUTPUT_LOST
                   : heard == sync::HostTime{} ? node_health_t::READY
                   : now - heard > kInputLost  ? node_health_t::INPUT_LOST
                                               : node_health_t::RUNNING,
                   output.note());
    node.set_quality(output.quality(), static_cast<int>(audio::kQualities.size()));
    node.override_ticks(output.callbacks(), output.underflows(), output.callback_rate_Hz());
  }
  if (offline) {
    const std::string result = offline->result(output.settings().sample_rate_Hz, hits, dropped, sync::host_now());
    std::cerr << kAudio.node << ": " << result << std::endl;
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("audio_node", e);
}
