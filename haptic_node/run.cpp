// haptic_node: renders the contact force on the hand, at 1 kHz, one process per device.
//
//   in   TOUCH_MODEL                   the surfaces near its tool, newest only
//        CONTACT_EVENTS                begins and hits of its tool
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: tools, their paths and materials
//                                     and the pictures of their relief and friction
//        DEVICE_STATE                  of a device that another program drives
//        DEVICE_FORCE                  of others: a device that two command is lost
//        SETTING                       changes of its settings while it runs
//   out  TOOL_STATE                    every tick
//        DEVICE_FORCE                  to that program, every tick
//        SETTING_REPLY                 to each change of a setting
//        PRESENTED                     every begin and hit of its tool
//
// Losing TOUCH_MODEL or the device fades the force to zero and says so; losing CONTACT_EVENTS leaves touch without
// hit transients. The loop never waits for another node. With --log it hears a recorded run instead of the bus, its hand
// is where TOOL_STATE says that it was, and what it feels goes into --trace, as fast as it can; the same log gives the
// same bytes.
#include "haptic_node/run.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "haptic_node/offline.h"
#include "haptic_node/rendering/quality.h"
#include "haptic_node/session.h"
#include "haptic_node/rendering/tagged.h"
#include "lcmtypes/pointing.h"
#include "sync/node/live_settings.h"
#include "sync/node/node.h"
#include "sync/node/background_task.h"
#include "sync/clocks/pacing.h"
#include "sync/assets/scene_exchange.h"
#include "sync/node/modality_endpoint.h"

using namespace tactus;

int tactus::haptic::run(int argc, char** argv) try {
  const sync::NodeDescriptor declaration{
      .node = "haptic_node",
      .modality = "haptic",
      .owes = int{node_health_t::OWES_BEGIN} | node_health_t::OWES_HIT | node_health_t::OWES_OWN_TOOL_ONLY,
      .rate_Hz = haptic::Settings{}.rate_Hz,
      .fifo_priority = 60,
      .about = "Renders the contact force on the hand.",
      .inputs = {channels::kTouchModel, channels::kContactEvents},
      .presents = "the tick whose force shows it",
      .late = haptic::kLate,
      .degradable = {"force_step"}};
  CLI::App app;
  sync::NodeOptions options;
  options.add_to(app, declaration);
  std::string tool_name, device_spec;
  app.add_option("--tool", tool_name, "tool that the hand holds; default: the scene's first");
  app.add_option(
      "--device", device_spec,
      "virtual_hand, virtual_hand:FILE, playback:FILE[,scale=S][,offset=X/Y/Z][,rate=R], "
      "spidar:NAME|FILE.json[,offset=X/Y/Z] or external:NAME[,offset=X/Y/Z]; default: as the scene says");
  haptic::OfflineOptions of_log;
  of_log.add_to(app, "feels this log of a run", "--trace");
  app.add_option("--trace", of_log.trace, "file for what the hand feels in the log, CSV with the columns of haptic.csv")
      ->needs("--log")->excludes("--device");
  sync::parse_or_exit(app, declaration.node, argc, argv);
  const auto given = haptic::resolve_config(scene_t{}, tool_name, options.set);
  if (!given.refused.empty()) throw std::runtime_error(given.refused.front());
  std::shared_ptr<const haptic::DeviceSpec> device_given;
  if (!device_spec.empty())
    device_given = std::make_shared<haptic::DeviceSpec>(haptic::parse_device_spec(device_spec));

  std::optional<haptic::Offline> offline;
  if (!of_log.log.empty()) {
    if (of_log.trace.empty()) throw std::runtime_error("--log needs --trace FILE, which what the hand feels is written to");
    offline.emplace(of_log, declaration.rate_Hz, sync::host_now());
    offline->run().adapt(options);
  }

  sync::Node node(declaration, options);
  sync::SceneReceiver scenes(node.bus());
  auto& device_states = node.bus().queue<device_state_t>(channels::kDeviceState, 64);
  auto& device_forces = node.bus().queue<device_force_t>(channels::kDeviceForce, 64);
  haptic::Safety safety(haptic::safety_limits(given.settings));  // one for all scenes
  haptic::NodeConfig choice;
  haptic::Quality quality(given.settings);
  std::optional<sync::BackgroundTask<haptic::Device>> device;
  // Read in a thread of its own; what is not there yet is smooth.
  std::optional<sync::BackgroundTask<haptic::SurfaceMaps>> opening_maps;
  std::shared_ptr<const haptic::SurfaceMaps> maps;
  std::optional<haptic::Session> session;
  bool points = false;    // its tool is a wand or the head: there is no touch to wait for
  bool no_touch = false;  // so are all tools of the scene: no touch model says that the world has begun
  sync::LiveSettings live(node);
  // A safety limit may not become looser than the scene has it, nor the command line.
  haptic::Settings own = given.settings;
  const auto change = [&](const std::string& name, const std::string& value) {
    if (!session) throw std::invalid_argument("it has no scene yet: nothing of it can be changed");
    sync::change_live(choice.settings, own, haptic::setting_fields(), name, value);
    session->change(choice.settings);
  };
  tool_state_t told{};  // last; for who records it
  haptic::tag(node.tags(), told);
  sync::ModalityEndpoint sense(node);
  auto& touch = sense.held_snapshots<touch_model_t>(channels::kTouchModel, 1024);
  auto& events = sense.events();
  if (offline) sense.tell([&](const presentation_t& report) { offline->run().note(declaration.modality, report); });
  node.set_state(node_health_t::WAITING, "waits for the scene");

  while (node.running() && !(offline && offline->over())) {
    const sync::HostTime now = offline ? offline->next(node.bus()) : node.wait();
    sense.step(now);
    if (scenes.poll(now)) {
      choice = haptic::resolve_config(*scenes.scene(), tool_name, options.set);
      own = choice.settings;
      live.set_scene(*scenes.scene());
      for (const std::string& refused : choice.refused) std::cerr << refused << "\n";
      if (session) session->let_go();
      device.reset();
      maps.reset();
      opening_maps.emplace([scene = *scenes.scene(), pictures = sync::pictures_of(scenes)] {
        sync::leave_realtime();
        return std::make_unique<haptic::SurfaceMaps>(haptic::read_maps(scene, pictures));
      });
      if (choice.tool >= 0)  // its file is read in a thread of its own, at no priority
        device.emplace([scene = *scenes.scene(), choice, given = device_given, &offline] {
          sync::leave_realtime();
          return offline ? offline->device() : haptic::device_of(scene, choice, given.get());
        });
      if (offline) offline->follow(choice.tool);
      std::cerr << options.name << ": "
                << (choice.tool >= 0 ? haptic::limits_sentence(choice.settings) : choice.problem) << "\n";
      node.set_tool(choice.tool);
      points = choice.tool >= 0 &&
               only_points(scenes.scene()->tools[static_cast<std::size_t>(choice.tool)], scenes.scene()->lights);
      no_touch = std::all_of(scenes.scene()->tools.begin(), scenes.scene()->tools.end(),
                             [&](const tool_def_t& t) { return only_points(t, scenes.scene()->lights); });
      sense.set_scene(*scenes.scene(), choice.tool);
      sense.set_output_latency(sync::from_seconds(1 / choice.settings.rate_Hz));
      node.set_rate(choice.settings.rate_Hz);
      quality = haptic::Quality(choice.settings);
      node.set_state(node_health_t::WAITING, choice.tool >= 0 ? "waits for its device" : choice.problem);
    }
    while (offline && ((opening_maps && !opening_maps->done()) || (device && !device->done())))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (opening_maps && opening_maps->done()) {
      maps = opening_maps->take();
      opening_maps.reset();
      if (!maps->trouble.empty()) std::cerr << options.name << ": " << maps->trouble << "\n";
      if (session && !session->over()) session->set_maps(maps);
    }
    if (device && device->done()) {
      try {
        session.emplace(*scenes.scene(), choice, device->take(), node.bus().clocks(), safety);
        if (maps) session->set_maps(maps);
        node.set_state(node_health_t::READY, "waits for a touch model");
      } catch (const std::exception& e) {
        std::cerr << options.name << ": " << e.what() << "\n";
        node.set_state(node_health_t::WAITING, e.what());
      }
      device.reset();
    }
    while (auto m = touch.pop())
      if (session) session->push(std::move(m->message), m->arrival);
    while (const auto m = events.pop())
      if (session) session->push(m->message, m->arrival);
    while (const auto m = device_states.pop())
      if (session) session->push(m->message, m->arrival);
    // What others of this run command; a replayed log commands nothing.
    const sync::Identity& me = node.bus().identity();
    while (const auto m = device_forces.pop())
      if (session && m->message.header.incarnation != me.incarnation && m->message.header.run_id == me.run_id)
        session->push(m->message, m->arrival);
    for (const std::string& news : live.step(now, change)) std::cerr << options.name << ": " << news << "\n";
    if (!session || (offline && !offline->in_tick())) continue;
    std::optional<sync::ScopedPhaseTimer> rendering(sync::Phase::kRender);
    haptic::TickOutput& out = session->step(now,
                                            {.delay = sense.delay(),
                                             .touch_delay = sense.profile_delay(),
                                             .force_step_N = sense.output().force_step_N,
                                             .touch_arrival = no_touch ? now : touch.count().newest_arrival},
                                            quality.planes());
    rendering.reset();
    if (session->over()) continue;
    if (offline) offline->add(out.state);
    node.bus().publish(channels::kToolState, out.state);
    if (node.tags().wanted()) told = out.state;
    if (device_force_t* force = session->tell()) node.bus().publish(channels::kDeviceForce, *force);
    for (const presentation_t& report : out.reports) sense.report(report);
    sense.publish(now);
    if (!offline) quality.add(sync::host_now() - now);
    node.set_quality(quality.step(), quality.steps());
    node.count_rendered(static_cast<std::int64_t>(out.reports.size()));
    if (session->device_lost())
      node.set_state(node_health_t::OUTPUT_LOST, "the device does not answer, or two hold it: the force is zero");
    else if (points)
      node.set_state(node_health_t::RUNNING, "points, and does not touch");
    else if (session->heard() && session->lost())
      node.set_state(node_health_t::INPUT_LOST, "no touch model: the force is zero");
    else if (session->heard())
      node.set_state(node_health_t::RUNNING, maps ? maps->trouble : "reads the maps of its surfaces");
    else
      node.set_state(node_health_t::READY, "waits for a touch model");
    if (offline)
      if (const auto line = offline->run().progress(sync::host_now())) std::cerr << options.name << ": " << *line << std::endl;
  }
  if (offline) {
    const std::string result = offline->result(choice.problem, sync::host_now());
    std::cerr << options.name << ": " << result << std::endl;
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("haptic_node", e);
}
