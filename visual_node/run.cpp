// visual_node: draws the scene, its tools and a flash for every contact, at 60 Hz.
//
//   in   WORLD_STATE, CONTACT_EVENTS   where the bodies are, what began and what hit
//        TOOL_STATE                    where device and proxy of each tool are; of a head, where the eye is
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: shapes, lamps, camera
//        PLAYOUT, FRAME_SHOWN          of a room: its delay on the room's clock; which frames the other walls have drawn
//        SETTING                       changes of overlays and stream while it runs
//        QUESTION                      what the participant of a study is asked
//        CONTACTS, NODE_HEALTH         while an overlay shows them, and whatever a plot names
//   out  PRESENTED                     every begin and hit
//        MEDIA_CLOCK                   which frame of the video was out when
//        FRAME_SHOWN                   of a room: which frame was seen when
//        SIM_COMMAND, DEVICE_STATE     keys and mouse of a window
//        ANSWER                        keys and gamepad of a window, to a question
//        PICTURE_CHUNK                 the picture for who looks on, when streamed
//
// Losing WORLD_STATE carries bodies on for 50 ms, then holds them and says so in the picture; the loop waits for
// nobody. With --log it hears a recorded run instead of the bus and draws it into --video, as fast as it can; the same log gives
// the same pixels.
#include "visual_node/run.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "sync/node/live_settings.h"
#include "sync/node/node.h"
#include "sync/assets/scene_exchange.h"
#include "sync/node/modality_endpoint.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/frame/frame_lock.h"
#include "visual_node/frame/frame_times.h"
#include "visual_node/frame/wall_sync.h"
#include "visual_node/gl/render_output.h"
#include "visual_node/offline.h"
#include "visual_node/overlay/window_controls.h"
#include "visual_node/scene_view/meshes.h"
#include "visual_node/video/picture_stream.h"
#include "visual_node/video/recording.h"

using namespace tactus;

int tactus::visual::run(int argc, char** argv) try {
  visual::Settings settings;
  const sync::NodeDescriptor declaration{
      .node = "visual_node",
      .modality = "visual",
      .owes = int{node_health_t::OWES_BEGIN} | int{node_health_t::OWES_HIT},
      .rate_Hz = settings.rate_Hz,
      .about = "Draws the scene, its tools and a flash for every contact.",
      .inputs = {channels::kWorldState, channels::kContactEvents, channels::kToolState},
      .presents = "the fence after the frame that first shows it",
      .late = sync::Late::kShowNewest,
      .degradable = {"frame_rate", "resolution"},
      .phases = {sync::Phase::kRender}};
  CLI::App app;
  sync::NodeOptions options;
  options.add_to(app, declaration);
  visual::RecordingOptions keep;
  bool window = false, no_video = false, no_pictures = false;
  app.add_flag("--window", window, "open a window");
  app.add_flag("--no-video", no_video, "write no video.mp4");
  app.add_flag("--no-pictures", no_pictures, "draw nothing, and report what each picture would have shown")->excludes("--window");
  app.add_option("--snapshot", keep.snapshot, "PNG file that the newest picture is written to");
  app.add_option("--snapshot-every", keep.snapshot_every_s, "how often, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  visual::OfflineOptions of_log;
  of_log.add_to(app, "draws this log of a run", "--video");
  app.add_option("--video", of_log.video, "file for the pictures of the log, MP4")->needs("--log");
  app.get_option("--no-pictures")->excludes("--log");
  app.add_option("--frames", of_log.frames, "file for a table of when each frame of the log is and of the hash of its pixels, CSV")->needs("--log");
  app.add_flag("--as-recorded", of_log.as_recorded, "the same as --degrade logged")->needs("--log");
  sync::parse_or_exit(app, declaration.node, argc, argv);
  const std::vector<setting_t> no_scene;
  for (const std::string& wrong :
       sync::apply_settings(settings, visual::setting_fields(), declaration.node, no_scene, options.set))
    throw std::runtime_error(wrong);
  keep.folder = options.out;
  // Several of a room write into one folder.
  if (options.name.starts_with(declaration.node + "_")) keep.name += options.name.substr(declaration.node.size());
  keep.video = !no_video && !no_pictures;
  if (no_pictures && !keep.snapshot.empty()) throw std::runtime_error("--no-pictures leaves nothing for --snapshot; leave one out");

  std::optional<visual::Offline> offline;
  if (!of_log.log.empty()) {
    if (of_log.video.empty()) throw std::runtime_error("--log needs --video FILE, which the pictures are written to");
    of_log.snapshot = keep.snapshot, of_log.snapshot_every_s = keep.snapshot_every_s;
    offline.emplace(of_log, settings.rate_Hz, sync::host_now());
    offline->run().adapt(options);
  }
  const auto clock = [&] { return offline ? offline->now() : sync::host_now(); };
  visual::RenderOutput stage = no_pictures ? visual::RenderOutput(settings) : visual::RenderOutput(settings, window);
  std::cerr << declaration.node << ": " << stage.description() << std::endl;

  sync::Node node(declaration, options);
  node.set_rate(settings.rate_Hz);
  sync::SceneReceiver scenes(node.bus());
  sync::ModalityEndpoint sense(node);
  auto& world = sense.snapshots<world_state_t>(channels::kWorldState, 4096);
  auto& events = sense.events();
  auto& tools = sense.snapshots<tool_state_t>(channels::kToolState, 512);
  visual::FrameComposer composer(node.bus().clocks(), settings, declaration.late);
  composer.set_schedule([&](std::int64_t event, sync::HostTime happened) { return sense.schedule(event, happened); });
  visual::FrameLock lock(node.bus().clocks(), declaration.modality, node.bus().identity().incarnation);
  visual::WallSync walls(node, lock);
  if (offline) {
    composer.foresee({}, {});
    sense.tell([&](const presentation_t& report) { offline->run().note(declaration.modality, report); });
  }
  visual::Recording recording(keep);
  visual::PictureStream stream;
  visual::LiveOverlays overlays(node.bus());
  visual::WindowControls desk(node.bus());
  visual::LiveQuestions questions(node.bus());
  questions.configure(settings);
  sync::LiveSettings live(node);
  visual::Settings own = settings;
  visual::Frame frame;
  sync::HostTime fence{};
  visual::FrameTimes times;
  sync::Nanoseconds took{0}, waited{0};
  std::int64_t tick = -1, periods = 0;  // slot of the video; of the loop, ticked and missed
  std::int64_t owed = 0, flashed = 0;
  std::string said;
  const auto say = [&](const std::string& sentence) {
    std::cerr << declaration.node << ": " << sentence << std::endl;
  };
  for (const std::string& sentence : overlays.configure(settings)) say(sentence);
  const auto change = [&](const std::string& name, const std::string& value) {
    visual::Settings changed = settings;
    sync::change_live(changed, own, visual::setting_fields(), name, value);
    visual::LiveOverlays::check(changed);
    settings = changed;
    if (name.starts_with("stream") && !stage.draws()) throw std::invalid_argument("it draws no pictures that could be streamed");
    if (name.starts_with("stream"))
      stream.begin(stage.picture().width(), stage.picture().height(), settings);
    else
      overlays.configure(settings), questions.configure(settings), composer.change(settings);
  };
  const auto receive = [&](sync::HostTime now) {
    sense.step(now);
    while (const auto m = world.pop()) composer.push(m->message, m->arrival), overlays.push(m->message), desk.push(m->message);
    while (const auto m = events.pop()) composer.push(m->message, m->arrival), overlays.push(m->message, m->arrival);
    while (const auto m = tools.pop()) composer.push(m->message, m->arrival), overlays.push(m->message);
    walls.receive();
  };
  const auto load = [&](sync::HostTime now) {
    settings = {};
    for (const std::string& refused : sync::apply_settings(settings, visual::setting_fields(), declaration.node,
                                                           scenes.scene()->settings, options.set))
      std::cerr << refused << "\n";
    std::vector<std::string> trouble;
    const visual::SceneView& view = composer.load(*scenes.scene(), visual::meshes_of(scenes), settings,
                                                  visual::height_maps_of(*scenes.scene(), sync::pictures_of(scenes), trouble),
                                                  visual::look_files_of(scenes, trouble));
    trouble.insert(trouble.end(), view.trouble().begin(), view.trouble().end());
    if (!view.lens().trouble().empty()) trouble.push_back(view.lens().trouble());
    for (const std::string& sentence : overlays.configure(own = settings)) trouble.push_back(sentence);
    questions.configure(settings);
    for (const std::string& sentence : trouble) say(sentence);
    lock.load(*scenes.scene(), settings);
    node.set_state(node_health_t::WAITING, "prepares the pictures of the scene");
    stage.load(view, composer.frame(now, 0).list, settings, [&] { if (!offline) node.heartbeat(); });
    if (offline) offline->begin(view.width(), view.height(), settings);
    else if (stage.draws()) recording.begin(view.width(), view.height(), settings);
    if (stage.draws()) stream.begin(view.width(), view.height(), settings);
    node.set_rate(settings.rate_Hz);
    sense.set_scene(*scenes.scene());
    live.set_scene(*scenes.scene());
    sense.set_output_latency(sync::from_seconds(1 / settings.rate_Hz) + visual::FrameComposer::kFlashesTake);
  };
  node.tags().add("picture", "us", [&] { return sync::to_seconds(took) * 1e6; });
  node.tags().add("quality", "1", [&] { return stage.quality().step(); });
  node.tags().add("flashed", "1", &flashed);
  const auto draw = [&](sync::HostTime now, const std::optional<visual::AgreedFrame>& agreed) {
    const sync::ScopedPhaseTimer rendering(sync::Phase::kRender);
    const sync::OutputDef output = sense.output();
    overlays.tint(composer, scenes.scene() ? scenes.scene()->bodies.size() : 0);
    const sync::HostTime heard = world.count().newest_arrival;
    frame = agreed ? composer.frame(now, *agreed, heard)
                   : composer.frame(now, tick, sense.delay(), heard, sense.profile_delay());
    stage.draw_scene(frame.list, output);
    const sync::HostTime drawn = clock();
    if (agreed && !offline) walls.wait_for_latch(*agreed);
    // Late latch: what arrived while the surfaces were drawn still flashes in this frame.
    const sync::HostTime latched = offline ? clock() : node.poll();
    if (!offline) receive(latched);
    composer.latch(frame, latched, agreed ? agreed->delay : sense.delay(), stage.held());
    if (overlays.on().any() && stage.draws()) {
      visual::PanelFacts facts;
      facts.rendering = took;
      facts.period = sync::from_seconds(1 / settings.rate_Hz);
      facts.quality = stage.quality().step();
      facts.qualities = stage.quality().steps();
      facts.profile = sense.profile_name();
      facts.delay = sense.delay();
      facts.profile_delay = sense.profile_delay();
      facts.output = output;
      overlays.append(frame, facts, latched, stage.picture().width(), stage.picture().height());
    }
    if (stage.draws()) questions.append(frame, latched, stage.picture().width(), stage.picture().height());
    stage.draw_over(frame.list);
    const sync::HostTime ready = clock();
    if (agreed && !offline) lock.drawn(drawn - now, ready - latched), walls.hold(*agreed, receive);
    waited = agreed ? (latched - drawn) + (clock() - ready) : sync::Nanoseconds(0);
    stage.show();
    fence = clock();
    times = {now, latched};
    took = fence - now;
    if (agreed && !offline) walls.shown(*agreed);
    const sync::HostTime shown = fence + sync::from_seconds(settings.display_latency_s);
    questions.presented(shown);
    // An event that arrives just after the latch waits for that of the next frame; not for a picture that a
    // profile holds.
    if (!output.any()) sense.set_output_latency(shown - latched + sync::from_seconds(1 / settings.rate_Hz));
    std::int64_t rendered = 0;
    for (const presentation_t& report : composer.presented(shown)) {
      sense.report(report);
      rendered += report.outcome != presentation_t::DROPPED_LATE;
      ++owed;
    }
    node.count_rendered(rendered);
    flashed += rendered;
  };

  while (node.running() && !stage.closed() && !desk.closing() && !(offline && offline->run().over())) {
    const sync::HostTime now = offline ? offline->run().next(node.bus()) : node.wait();
    receive(now);
    if (scenes.poll(now)) {
      load(now);
      if (!offline) continue;  // that took several ticks
    }
    if (const std::string lost = stage.recover(now, composer.view(), frame.list); !lost.empty()) say(lost);
    for (const std::string& sentence : stage.take_trouble()) say(sentence);
    if (lock.on() && !offline) walls.catch_up(receive);  // a wall that is slow hears of its head all the same
    for (const std::string& sentence : live.step(now, change)) say(sentence);
    const auto agreed = lock.begin(clock(), sense.profile_delay());
    const std::int64_t periods_before = std::exchange(periods, node.deadlines().ticks() + node.deadlines().missed());
    tick += offline ? 1 : agreed ? 1 + agreed->skipped : periods - periods_before;
    const visual::SceneView* view = composer.view();
    if (stage.draws()) questions.step();
    if (!offline && stage.draws())
      desk.step(now, stage.display(), overlays, questions, frame.list, view ? std::span(view->geometries()) : std::span<const visual::Triangles>{}, say);
    const bool fresh = stage.due(now, sense.output());
    if (fresh) draw(agreed ? clock() : now, agreed);
    sense.publish(clock());
    const auto read = [&](std::span<std::uint8_t> rgba) { stage.picture().read(rgba); };
    if (offline) {
      offline->add(read);
      if (const auto line = offline->run().progress(sync::host_now())) say(*line);
      continue;
    }
    if (auto pair = stage.draws() ? recording.add(tick, fresh ? fence : now + took, read) : std::nullopt) {
      times.read = sync::host_now();
      node.bus().publish(channels::kMediaClock, *pair);
      if (fresh && settings.motion_marker == "strip")
        for (media_clock_t& m : visual::stages_of(*pair, times)) node.bus().publish(channels::kMediaClock, m);
    }
    if (fresh && stage.draws()) stream.add(now, frame.instant ? sync::to_ns(*frame.instant) : -1, fence + sync::from_seconds(settings.display_latency_s), read);
    for (picture_chunk_t& chunk : stream.take_chunks()) node.bus().publish(channels::kPictureChunk, chunk, sync::Port::kBulk);
    if (const std::string trouble = recording.trouble(); trouble != said) say(said = trouble);
    const std::string walls_note = lock.note(now), video = walls_note.empty() ? recording.note() : walls_note;
    node.set_state(frame.state, frame.note + (frame.note.empty() || video.empty() ? "" : "; ") + video);
    visual::QualityControl& quality = stage.quality();
    if (fresh && scenes.scene()) quality.add(sync::host_now() - now - waited);
    if (const std::string change = quality.take_change(); !change.empty()) say(change);
    node.set_quality(quality.step(), quality.steps());
    if (agreed) node.align(lock.next_begin(sync::host_now()), agreed->skipped);
  }
  if (stage.closed() || desk.closing()) say("the window was closed");
  if (offline) say(offline->result(flashed, owed - flashed, sync::host_now()));
  if (const std::string how = composer.poses().text(); !how.empty()) say("poses of bodies in the pictures: " + how);
  return 0;
} catch (const std::exception& e) {
  return sync::fail("visual_node", e);
}
