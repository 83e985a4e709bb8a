#include "audio_node/renderer.h"

#include <algorithm>
#include <thread>
#include <tactus/contact_event_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "audio_node/devices/file_output.h"
#include "audio_node/excitation/mesh_extent.h"
#include "sync/clocks/pacing.h"
#include "sync/time/phases.h"
#include "sync/node/realtime.h"
#include "sync/assets/scene_pictures.h"
#include "sync/text/error_text.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::audio {
namespace {

constexpr int kCallbackPriority = 70;
constexpr sync::Nanoseconds kSceneTimeout{2'000'000'000};  // the scene may select the card, but may be missing
constexpr sync::Nanoseconds kInputTimeout{300'000'000};     // contact snapshots arrive at 60 Hz
constexpr sync::Nanoseconds kContactsTimeout{100'000'000};  // six snapshots
constexpr sync::Nanoseconds kScrapeLead{3'000'000};      // before the callback needs it: two ticks and a step of the grid
// Lasting contacts are sampled at multiples of this simulated time: their sound then depends on the world alone, and not on the
// phase of the ticks, which differs between a run and the rendering of its log.
constexpr sync::Nanoseconds kGrid{1'000'000};
constexpr sync::Nanoseconds kMaxStepBack{100'000'000};   // design: a grid that becomes coarser steps back by 17 ms at most
// Design: half a tick; a blow takes up to 0.3 ms to prepare. Simultaneous blows wait for the next ticks.
constexpr sync::Nanoseconds kStrikeBudget{500'000};
constexpr sync::Nanoseconds kEarlyWindow{20'000'000};  // accepts events of the near future, in case a map lags

void publish_pair(sync::Bus& bus, const std::string& medium, const MediaPair& pair) {
  media_clock_t m{};
  m.header.sim_time_ns = -1;
  m.medium = medium;
  m.index = pair.index;
  m.host_time_ns = pair.host_ns;
  m.reason = static_cast<std::int8_t>(pair.reason);
  bus.publish(channels::kMediaClock, m);
}

// Freeing tables of 200 MB takes 20 ms, too long for the loop.
template <class Released>
void free_in_background(Released released) {
  if (!released.empty()) std::thread([gone = std::move(released)] { sync::leave_realtime(); }).detach();
}

// A multiple of the grid, at least one step.
sync::Nanoseconds whole_steps(sync::Nanoseconds interval) {
  return std::max<std::int64_t>(1, (interval + kGrid - sync::Nanoseconds(1)) / kGrid) * kGrid;
}

sync::SimTime on_grid(sync::SimTime t, sync::Nanoseconds step) { return t - t.time_since_epoch() % step; }

bool in_real_time(bool live) { return live && !sync::VirtualTime::current(); }

}  // namespace

void Options::add_to(sync::Arguments& app) {
  app.add_option("--audio-device", device, "sound card: default, virtual, or part of its name");
  app.add_flag("--no-sound", no_sound, "compute no samples, and report when each sound would have begun; only in virtual time");
  log.add_to(app);
}

void Options::check() const {
  if (no_sound && !sync::VirtualTime::current())
    throw std::runtime_error("--no-sound is for virtual time; for a quiet run in real time choose --audio-device virtual, which plays into a file");
}

NodeRenderer::NodeRenderer(sync::RendererHost& host, const Options& options, Offline* log)
    : SettingsRenderer(host, setting_fields()),
      log_(log),
      no_sound_(options.no_sound),
      real_time_(in_real_time(host.live())),
      events_(host.endpoint().events()),
      frames_(host.endpoint().snapshots<contact_frame_t>(channels::kContacts, 4096)),
      world_(host.endpoint().snapshots<world_state_t>(channels::kWorldState, 4096)),
      tools_(host.bus().queue<tool_state_t>(channels::kToolState, 512)),
      listener_(host.bus().clocks()),
      contacts_(events_.inbox()),
      bodies_(host.bus().clocks()),
      output_(host.options().out, options.device, kCallbackPriority,
              log          ? log->open_card()
              : real_time_ ? OpenCard{}
                           : open_files(host.options().out, no_sound_ ? "null" : options.device),
              no_sound_),
      started_(host.clock()) {
  configure(settings());
  add_tags();
}

void NodeRenderer::add_tags() {
  sync::Tags& tags = host().node().tags();
  tags.add("hits", "1", &hits_);
  tags.add("dropped", "1", &dropped_);
  tags.add("callbacks", "1", [this] { return static_cast<double>(output_.callbacks()); }, 100);
  tags.add("underflows", "1", [this] { return static_cast<double>(output_.underflows()); }, 100);
  tags.add("latency", "s", [this] { return sync::to_seconds(output_.latency()); }, 100);
}

void NodeRenderer::configure(const Settings& settings) {
  if (!find_instructions(settings.instructions))
    host().print_status("this machine has no " + settings.instructions + " instructions; it computes with " +
               name(available_instructions().back()));
  output_.configure(settings);
  host().endpoint().set_own_delay(sync::from_seconds(settings.presentation_delay_s));
  host().endpoint().set_output_latency(output_.latency());
}

sync::LoadedScene NodeRenderer::load(const sync::SceneReceiver& scenes, const Settings& settings) {
  scene_ = scenes.scene();
  listener_.set_scene(*scene_);
  configure(settings);
  const auto extent = [&](std::int64_t hash) -> std::optional<Extent> {
    const sync::Asset* asset = scenes.asset(hash);
    const auto mesh = asset ? sync::decode_asset<mesh_t>(asset->bytes) : std::nullopt;
    return mesh ? extent_of(*mesh) : std::nullopt;
  };
  impacts_ = std::make_unique<Impacts>(*scene_, extent, output_.settings(), output_.settings().sample_rate_Hz, ++scenes_);
  sampler_ = std::make_unique<Sampler>(*scene_, output_.settings());
  start_loading_surfaces(scenes);
  return {.output_latency = output_.latency()};
}

void NodeRenderer::start_loading_surfaces(const sync::SceneReceiver& scenes) {
  sliding_.reset();
  output_.set_surfaces(nullptr);
  loading_surfaces_.emplace([of = *scene_, pictures = sync::pictures_of(scenes)] {
    sync::leave_realtime();
    return load_surfaces(of, pictures);
  });
}

void NodeRenderer::apply_setting(const Settings& settings, const std::string&) {
  output_.configure(settings);
  if (sampler_) sampler_->configure(output_.settings());
  if (impacts_) impacts_->set_gain(settings.gain);
  if (sliding_) sliding_->set_gain(settings.gain);
}

void NodeRenderer::poll_loading() {
  while (!real_time_ && loading_surfaces_ && !loading_surfaces_->done())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (loading_surfaces_ && loading_surfaces_->done()) take_surfaces();
  free_in_background(output_.take_released());
  free_in_background(output_.step_library());
  while (!real_time_ && output_.library().reading()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    output_.step_library();
  }
  if (sampler_) sampler_->set_database(output_.library().database(), output_.library().number());
}

void NodeRenderer::take_surfaces() {
  auto surfaces = std::make_shared<const AudioSurfaces>();
  try {
    surfaces = loading_surfaces_->take();
  } catch (const std::exception& e) {
    host().print_status(std::string("cannot read the maps of the scene (") + sync::error_text(e) + "); scraping contacts sound without them");
  }
  loading_surfaces_.reset();
  output_.set_surfaces(surfaces);
  sliding_ = std::make_unique<Sliding>(*scene_, surfaces, bodies_, *impacts_, output_.settings(),
                                       output_.settings().sample_rate_Hz);
}

void NodeRenderer::receive() {
  contacts_.extend_history(host().endpoint().delay());
  bodies_.extend_history(host().endpoint().delay());
  while (const auto m = frames_.pop()) contacts_.push(m->message, m->arrival);
  while (const auto m = world_.pop()) bodies_.push(m->message, m->arrival);
  while (const auto m = tools_.pop()) listener_.push(m->message, m->arrival);
}

std::optional<sync::Status> NodeRenderer::step(sync::HostTime now) {
  poll_loading();
  const bool plays = (impacts_ || (real_time_ && now - started_ > kSceneTimeout)) && output_.keep_open(now);
  const sync::ModalityEndpoint& endpoint = host().endpoint();
  output_.set_presentation_delay(endpoint.delay());
  if (log_) log_->run().set_delay(std::max(sync::Nanoseconds(0), endpoint.delay() - Offline::kDecayTime / 2));
  output_.degrade({endpoint.output().value("dropout"), endpoint.output().value("dropout.every")});
  if (scene_) output_.set_listener(listener_.at(now + output_.latency()));
  receive();
  process_due_hits(now);
  submit_contacts(now);
  publish();
  print_messages();
  return status(now, plays);
}

void NodeRenderer::process_due_hits(sync::HostTime now) {
  const auto map = contacts_.map(now);
  if (!map || !impacts_ || !sampler_) return;
  const sync::ScopedPhaseTimer rendering(sync::Phase::kRender);
  // A log is rendered as fast as possible, for any duration of a tick.
  const sync::HostTime begun = sync::host_now();
  const Settings& settings = output_.settings();
  const auto schedule = [&](const contact_event_t& e) {
    return host().endpoint().schedule(e.event_id, map->to_host(sync::sim_time(e.time_ns)));
  };
  hits_ += strike_due_hits(events_.inbox(), map->to_sim(now + kEarlyWindow), now,
                           late_policy(settings.sample_rate_Hz, sync::from_seconds(settings.late_limit_s)),
                           HitActions{schedule, [&] { return !real_time_ || sync::host_now() - begun < kStrikeBudget; },
                                      [&](const contact_event_t& e, sync::HostTime scheduled) { strike(e, scheduled); },
                                      [&](const contact_event_t& e, sync::HostTime scheduled) { drop(e, scheduled); }});
}

void NodeRenderer::strike(const contact_event_t& event, sync::HostTime scheduled) {
  impacts_->set_listener(listener_.at(scheduled));
  Strike strike = impacts_->strike(event, scheduled, [&](int body) -> std::optional<Eigen::Isometry3d> {
    const auto pose = bodies_.pose(body, sync::sim_time(event.time_ns));
    if (pose.status == sync::SampleStatus::kNone) return std::nullopt;
    return Eigen::Translation3d(pose.value.position) * pose.value.orientation;
  });
  sampler_->add_recordings(strike, event, *impacts_);
  output_.submit(strike, impacts_->table());
}

void NodeRenderer::submit_contacts(sync::HostTime now) {
  const auto map = contacts_.map(now);
  if (no_sound_ || !map || !sampler_) return;
  const sync::Nanoseconds every = whole_steps(output_.update_interval(kScrapeLead));
  if (sliding_) sliding_->set_update_interval(sync::to_seconds(every));
  // The state is presented with the delay of this modality, or as soon as the callback can.
  const sync::Nanoseconds delay = host().endpoint().delay(), ahead = output_.latency() + kScrapeLead;
  const sync::SimTime newest = map->to_sim(std::min(now, now + ahead - delay));
  const auto due = [&](const std::optional<sync::SimTime>& last, sync::Nanoseconds step) -> std::optional<sync::SimTime> {
    const sync::SimTime t = on_grid(newest, step);
    const bool replaced = last && t < *last - kMaxStepBack;  // the world began again
    return !last || t > *last || replaced ? std::optional(t) : std::nullopt;
  };
  const auto t = due(submitted_at_, every);
  if (!t) return;
  const bool slides = sliding_ && due(scraped_at_, whole_steps(sync::from_seconds(sliding_->period_s()))).has_value();
  if (!slides && !sampler_->enabled()) return;
  submitted_at_ = *t;
  sampler_->set_update_interval(sync::to_seconds(every));
  const sync::HostTime happened = map->to_host(*t);
  const sync::HostTime presented_at = std::max(host().endpoint().presentation_of(happened), happened + ahead);
  if (sliding_) sliding_->set_listener(listener_.at(presented_at));
  sampler_->set_listener(listener_.at(presented_at));
  // Without contact snapshots they would never end.
  const bool known = now - frames_.newest_arrival() < kContactsTimeout;
  const sync::Contacts lasting = known ? contacts_.state_at(*t).value : sync::Contacts{};
  for (const RecordedContact& contact : sampler_->recorded_contacts(lasting, presented_at)) output_.submit(contact);
  if (!slides) return;
  const double step_s = scraped_at_ ? sync::to_seconds(*t - *scraped_at_) : 0;
  for (Scrape scrape : sliding_->scrapes(lasting, *t, presented_at, step_s)) {
    scrape.slide *= sampler_->modal_gain(scrape.id, Interaction::kScrape);
    scrape.roll *= sampler_->modal_gain(scrape.id, Interaction::kRoll);
    output_.submit(scrape);
  }
  scraped_at_ = *t;
}

void NodeRenderer::publish() {
  while (const auto report = output_.next_report()) {
    host().report(*report, report->presented_ns >= 0);
    dropped_ += report->outcome == presentation_t::DROPPED_LATE || report->outcome == presentation_t::DROPPED_BY_PROFILE;
  }
  while (const auto pair = output_.next_pair()) publish_pair(host().bus(), output_.medium(), *pair);
}

void NodeRenderer::print_messages() {
  for (const std::string& message : output_.library().take_messages()) host().print_status(message);
  if (sampler_)
    for (const std::string& message : sampler_->take_messages()) host().print_status(message);
  if (const auto message = output_.take_status_change()) host().print_status(*message);
}

sync::Status NodeRenderer::status(sync::HostTime now, bool plays) {
  host().node().override_ticks(output_.callbacks(), output_.underflows(), output_.callback_rate_Hz());
  const sync::HostTime newest_input = std::max(events_.newest_arrival(), frames_.newest_arrival());
  const bool first_input = newest_input == sync::HostTime{};
  // The world waits for a sense that prepares, so that its first sounds have their maps and recordings.
  const bool prepares = output_.opening() || (first_input && (loading_surfaces_ || output_.library().reading()));
  const std::int8_t state = !impacts_ || prepares                ? node_health_t::WAITING
                            : !plays                             ? node_health_t::OUTPUT_LOST
                            : first_input                        ? node_health_t::READY
                            : now - newest_input > kInputTimeout ? node_health_t::INPUT_LOST
                                                                 : node_health_t::RUNNING;
  return {state, output_.status_text(), output_.quality(), static_cast<int>(kQualities.size())};
}

}  // namespace tactus::audio
