#include "visual_node/renderer.h"

#include <stdexcept>
#include <tactus/media_clock_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>
#include <utility>

#include "sync/clocks/pacing.h"
#include "sync/time/phases.h"
#include "sync/assets/scene_pictures.h"
#include "sync/pictures/confined_pictures.h"
#include "visual_node/scene_view/meshes.h"

namespace tactus::visual {

void Options::add_to(sync::Arguments& app) {
  app.add_flag("--window", window, "open a window");
  app.add_flag("--no-video", no_video, "write no video.mp4");
  app.add_flag("--no-pictures", no_pictures, "draw nothing, and report what each picture would have shown").excludes("--window");
  app.add_option("--snapshot", recording.snapshot, "PNG file that the newest picture is written to");
  app.add_option("--snapshot-every", recording.snapshot_every_s, "interval between two snapshots, s").positive().show_default();
  log.add_to(app);
  app.option("--no-pictures").excludes("--log");
}

void Options::complete(const std::string& node, const sync::NodeOptions& options) {
  recording.folder = options.out;
  // Several processes of a room write into one folder.
  if (options.name.starts_with(node + "_")) recording.name += options.name.substr(node.size());
  recording.video = !no_video && !no_pictures;
  if (no_pictures && !recording.snapshot.empty())
    throw std::runtime_error("--no-pictures and --snapshot contradict each other; remove one");
  if (options.check && !recording.snapshot.empty()) sync::check_folder_of(recording.snapshot, "--snapshot");
  log.snapshot = recording.snapshot;
  log.snapshot_every_s = recording.snapshot_every_s;
}

std::unique_ptr<RenderOutput> open_render_output(const Settings& settings, const Options& options) {
  return options.no_pictures ? std::make_unique<RenderOutput>(settings) : std::make_unique<RenderOutput>(settings, options.window);
}

NodeRenderer::NodeRenderer(sync::RendererHost& host, RenderOutput& render_output, const Options& options,
                           Offline* log)
    : SettingsRenderer(host, setting_fields()),
      render_output_(render_output),
      log_(log),
      world_(host.endpoint().snapshots<world_state_t>(channels::kWorldState, 4096)),
      events_(host.endpoint().events()),
      tools_(host.endpoint().snapshots<tool_state_t>(channels::kToolState, 512)),
      composer_(host.bus().clocks(), settings(), host.descriptor().late_rule, &events_.inbox()),
      lock_(host.bus().clocks(), host.descriptor().modality, host.bus().identity().incarnation),
      walls_(host.node(), lock_),
      recording_(options.recording),
      overlays_(host.bus(), events_.inbox()),
      controls_(host.bus()),
      questions_(host.bus(), log != nullptr) {
  host.node().set_rate(settings().rate_Hz);
  composer_.set_schedule([&endpoint = host.endpoint()](std::int64_t event, sync::HostTime happened) {
    return endpoint.schedule(event, happened);
  });
  if (log_) composer_.set_expected_times({}, {});
  questions_.configure(settings());
  report_all(overlays_.configure(settings()));
  add_tags();
}

void NodeRenderer::add_tags() {
  sync::Tags& tags = host().node().tags();
  tags.add("picture", "us", [this] { return sync::to_seconds(draw_time_) * 1e6; });
  tags.add("quality", "1", [this] { return render_output_.quality().step(); });
  tags.add("flashed", "1", &flashed_);
}

void NodeRenderer::report_all(const std::vector<std::string>& sentences) const {
  for (const std::string& sentence : sentences) host().print_status(sentence);
}

sync::LoadedScene NodeRenderer::load(const sync::SceneReceiver& scenes, const Settings& settings) {
  process_messages();
  loaded_ = true;
  scene_ = scenes.scene();
  std::vector<std::string> warnings;
  sync::ConfinedPictures reader;
  const SceneView& view = composer_.load(*scene_, meshes_of(scenes), settings,
                                         height_maps_of(*scene_, sync::pictures_of(scenes), reader, warnings),
                                         look_files_of(scenes, reader, warnings));
  warnings.insert(warnings.end(), view.warnings().begin(), view.warnings().end());
  if (!view.lens().warning().empty()) warnings.push_back(view.lens().warning());
  for (const std::string& sentence : overlays_.configure(settings)) warnings.push_back(sentence);
  questions_.configure(settings);
  report_all(warnings);
  lock_.load(*scene_, settings);
  const sync::Status preparing{node_health_t::WAITING, "prepares the pictures of the scene"};
  host().node().set_state(preparing.state, preparing.text);
  const DrawList sample = composer_.frame(host().clock(), 0).list;
  const auto meanwhile = [this] {
    if (!log_) host().node().heartbeat();
  };
  render_output_.load(view, sample, settings, meanwhile);
  // The pictures of a log do not depend on the time that they take.
  if (host().live()) render_output_.start_quality(sample, sync::host_now, meanwhile);
  start_outputs(view, settings);
  return {.rate_Hz = settings.rate_Hz,
          .output_latency = sync::from_seconds(1 / settings.rate_Hz) + FrameComposer::kInitialFlashTime,
          .status = preparing};
}

void NodeRenderer::start_outputs(const SceneView& view, const Settings& settings) {
  if (log_)
    log_->begin(view.width(), view.height(), settings);
  else if (render_output_.draws())
    recording_.begin(view.width(), view.height(), settings);
  if (render_output_.draws()) stream_.begin(view.width(), view.height(), settings);
}

void NodeRenderer::apply_setting(const Settings& settings, const std::string& name) {
  process_messages();  // they were sent before the change
  LiveOverlays::check(settings);
  if (name.starts_with("stream")) {
    if (!render_output_.draws())
      throw std::invalid_argument("it draws no pictures (--no-pictures), so there is nothing to stream");
    stream_.begin(render_output_.picture().width(), render_output_.picture().height(), settings);
  } else {
    overlays_.configure(settings);
    questions_.configure(settings);
    composer_.change(settings);
  }
}

// Processes the messages that arrived during a wait within a tick.
void NodeRenderer::receive(sync::HostTime now) {
  host().endpoint().step(now);
  process_messages();
}

void NodeRenderer::process_messages() {
  while (const auto m = world_.pop())
    composer_.push(m->message, m->arrival), overlays_.push(m->message), controls_.push(m->message);
  while (const auto m = tools_.pop()) composer_.push(m->message, m->arrival);
  walls_.receive();
}

std::optional<sync::Status> NodeRenderer::step(sync::HostTime now) {
  process_messages();
  if (std::exchange(loaded_, false) && host().live()) return std::nullopt;  // loading took several ticks
  recover(now);
  const std::optional<LockedFrame> locked = begin_frame();
  const SceneView* view = composer_.view();
  if (render_output_.draws()) questions_.step();
  if (host().live() && render_output_.draws())
    controls_.step(now, render_output_.display(), overlays_, questions_, frame_.list,
                   view ? std::span(view->geometries()) : std::span<const Triangles>{},
                   [this](const std::string& sentence) { host().print_status(sentence); });
  const bool fresh = render_output_.due(now, host().endpoint().output());
  if (fresh) draw(locked ? host().clock() : now, locked);
  host().endpoint().publish(host().clock());  // before the pixels are read back
  record(now, fresh);
  if (log_) return std::nullopt;
  const sync::Status status = this->status(now, fresh);
  if (locked) host().node().align(lock_.next_begin(sync::host_now()), locked->skipped);
  return status;
}

void NodeRenderer::recover(sync::HostTime now) {
  if (const std::string lost = render_output_.recover(now, composer_.view(), frame_.list); !lost.empty())
    host().print_status(lost);
  report_all(render_output_.take_warnings());
}

// Selects the frame of this tick; in a room, the frame that all walls show.
std::optional<LockedFrame> NodeRenderer::begin_frame() {
  // A slow wall also needs the newest pose of the head.
  if (lock_.active() && host().live()) walls_.catch_up([this](sync::HostTime now) { receive(now); });
  const auto locked = lock_.begin_frame(host().clock(), host().endpoint().profile_delay());
  const sync::Deadlines& deadlines = host().node().deadlines();
  const std::int64_t before = std::exchange(periods_, deadlines.ticks() + deadlines.missed());
  slot_ += log_ ? 1 : locked ? 1 + locked->skipped : periods_ - before;
  return locked;
}

void NodeRenderer::draw(sync::HostTime now, const std::optional<LockedFrame>& locked) {
  const sync::ScopedPhaseTimer rendering(sync::Phase::kRender);
  const sync::ModalityEndpoint& endpoint = host().endpoint();
  const auto meanwhile = [this](sync::HostTime t) { receive(t); };
  output_ = endpoint.output();
  overlays_.tint(composer_, scene_ ? scene_->bodies.size() : 0);
  const sync::HostTime newest_arrival = world_.newest_arrival();
  frame_ = locked ? composer_.frame(now, *locked, newest_arrival, endpoint.profile_delay())
                  : composer_.frame(now, slot_, endpoint.delay(), newest_arrival, endpoint.profile_delay());
  render_output_.draw_scene(frame_.list, output_);
  const sync::HostTime drawn = host().clock();
  if (locked && !log_) walls_.wait_for_latch(*locked);
  // Late latch: events that arrived while the surfaces were drawn still flash in this frame.
  const sync::HostTime latched = log_ ? host().clock() : host().node().poll();
  if (!log_) receive(latched);
  composer_.latch(frame_, latched, locked ? locked->delay : endpoint.delay(), render_output_.held());
  draw_overlays(latched);
  const sync::HostTime ready = host().clock();
  if (locked && !log_) lock_.add_draw_times(drawn - now, ready - latched), walls_.hold(*locked, meanwhile);
  wait_time_ = locked ? (latched - drawn) + (host().clock() - ready) : sync::Nanoseconds(0);
  render_output_.show();
  fence_ = host().clock();
  times_ = {now, latched};
  draw_time_ = fence_ - now;
  if (locked && !log_) walls_.shown(*locked);
  present(latched);
}

void NodeRenderer::draw_overlays(sync::HostTime latched) {
  if (overlays_.on().any() && render_output_.draws()) {
    const sync::ModalityEndpoint& endpoint = host().endpoint();
    PanelData panel;
    panel.rendering = draw_time_;
    panel.period = sync::from_seconds(1 / settings().rate_Hz);
    panel.quality = render_output_.quality().step();
    panel.qualities = render_output_.quality().steps();
    panel.profile = endpoint.profile_name();
    panel.delay = endpoint.delay();
    panel.profile_delay = endpoint.profile_delay();
    panel.output = output_;
    overlays_.append(frame_, panel, latched, render_output_.picture().width(), render_output_.picture().height());
  }
  if (render_output_.draws())
    questions_.append(frame_, latched, render_output_.picture().width(), render_output_.picture().height());
  if (const auto problem = questions_.take_problem()) host().print_status(*problem);
  render_output_.draw_flashes_and_overlay(frame_.list);
}

// The picture was presented: reports the events that it shows first.
void NodeRenderer::present(sync::HostTime latched) {
  const sync::HostTime shown = fence_ + sync::from_seconds(settings().display_latency_s);
  questions_.presented(shown);
  // An event that arrives just after the latch waits for the latch of the next frame. Pictures that a profile
  // holds are excluded.
  if (!output_.any())
    host().endpoint().set_output_latency(shown - latched + sync::from_seconds(1 / settings().rate_Hz));
  for (const presentation_t& report : composer_.presented(shown)) {
    const bool rendered = report.outcome != presentation_t::DROPPED_LATE;
    host().report(report, rendered);
    flashed_ += rendered;
    ++reported_;
  }
}

void NodeRenderer::record(sync::HostTime now, bool fresh) {
  const auto read = [this](std::span<std::uint8_t> rgba) { render_output_.picture().read(rgba); };
  if (log_) return log_->add(read);
  if (auto pair =
          render_output_.draws() ? recording_.add(slot_, fresh ? fence_ : now + draw_time_, read) : std::nullopt) {
    times_.read = sync::host_now();
    host().bus().publish(channels::kMediaClock, *pair);
    if (fresh && settings().motion_marker == "strip")
      for (media_clock_t& m : stages_of(*pair, times_)) host().bus().publish(channels::kMediaClock, m);
  }
  if (fresh && render_output_.draws())
    stream_.add(now, frame_.instant ? sync::to_ns(*frame_.instant) : -1,
                fence_ + sync::from_seconds(settings().display_latency_s), read);
  for (picture_chunk_t& chunk : stream_.take_chunks())
    host().bus().publish(channels::kPictureChunk, chunk, sync::Port::kBulk);
  if (const std::string error = recording_.error(); error != last_reported_error_)
    host().print_status(last_reported_error_ = error);
}

sync::Status NodeRenderer::status(sync::HostTime now, bool fresh) {
  const std::string walls = lock_.status_text(now), video = walls.empty() ? recording_.status_text() : walls;
  QualityControl& quality = render_output_.quality();
  if (fresh && scene_) quality.add(sync::host_now() - now - wait_time_);
  if (const std::string change = quality.take_change(); !change.empty()) host().print_status(change);
  return {frame_.state, frame_.note + (frame_.note.empty() || video.empty() ? "" : "; ") + video, quality.step(),
          quality.steps()};
}

void NodeRenderer::finish() {
  if (closed()) host().print_status("the window was closed");
  if (const std::string how = composer_.poses().text(); !how.empty()) host().print_status("poses of bodies in the pictures: " + how);
}

}  // namespace tactus::visual
