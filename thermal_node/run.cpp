// thermal_node: renders the temperature of what a tool touches on a Peltier element, at 50 Hz.
//
//   in   CONTACT_EVENTS, CONTACTS      what the tool touches, how firmly and for how long
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: tools and materials
//        THERMAL_DEVICE                what the display says of itself, if it does
//   out  THERMAL_STATE                 every tick
//        THERMAL_DEVICE                every tick, of the simulated display
//        PRESENTED                     every begin and hit of its tool
//
// Losing the display's answers, it is taken to be where it was commanded. Losing the contacts returns the command
// to the temperature of resting skin; the loop never waits for another node. With --log it hears a recorded run
// instead of the bus, and what it feels goes into --trace, as fast as it can; the same log gives the same bytes.
#include "thermal_node/run.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>

#include "sync/node/live_settings.h"
#include "sync/node/node.h"
#include "sync/clocks/pacing.h"
#include "sync/assets/scene_exchange.h"
#include "sync/node/modality_endpoint.h"
#include "thermal_node/devices/node_config.h"
#include "thermal_node/devices/external.h"
#include "thermal_node/devices/make_device.h"
#include "thermal_node/offline.h"
#include "thermal_node/display/quality.h"
#include "thermal_node/renderer.h"
#include "thermal_node/skin/thickness.h"

using namespace tactus;

int tactus::thermal::run(int argc, char** argv) try {
  const sync::NodeDescriptor declaration{
      .node = "thermal_node",
      .modality = "thermal",
      .owes = int{node_health_t::OWES_BEGIN} | node_health_t::OWES_HIT | node_health_t::OWES_OWN_TOOL_ONLY,
      .rate_Hz = thermal::Settings{}.rate_Hz,
      .about = "Renders the temperature of what a tool touches.",
      .inputs = {channels::kContacts, channels::kContactEvents},
      .presents = "the end of the tick whose heat holds it",
      .late = thermal::kLate,
      .degradable = {"response"},
      .phases = {sync::Phase::kRender}};
  CLI::App app;
  sync::NodeOptions options;
  options.add_to(app, declaration);
  std::string tool_name;
  app.add_option("--tool", tool_name, "tool whose touch is felt; default: the scene's choice, else its first");
  thermal::OfflineOptions of_log;
  of_log.add_to(app, "feels this log of a run", "--trace");
  app.add_option("--trace", of_log.trace, "file for what the skin feels in the log, CSV with the columns of thermal.csv")
      ->needs("--log");
  sync::parse_or_exit(app, declaration.node, argc, argv);
  const auto wrong = thermal::resolve_config(scene_t{}, "", options.set).refused;
  if (!wrong.empty()) throw std::runtime_error(wrong.front());
  std::optional<thermal::Offline> offline;
  if (!of_log.log.empty()) {
    if (of_log.trace.empty()) throw std::runtime_error("--log needs --trace FILE, which what the skin feels is written to");
    offline.emplace(of_log, thermal::resolve_config(scene_t{}, "", options.set).settings.rate_Hz, sync::host_now());
    offline->run().adapt(options);
  }

  sync::Node node(declaration, options);
  sync::SceneReceiver scenes(node.bus());
  sync::ModalityEndpoint sense(node);
  auto& events = sense.events();
  auto& frames = sense.snapshots<contact_frame_t>(channels::kContacts, 4096);
  auto& answers = node.bus().queue<thermal_device_t>(channels::kThermalDevice, 64);
  sync::ContactStream stream(node.bus().clocks());
  thermal::NodeConfig choice;
  thermal::Ticks ticks;
  thermal::Quality quality(choice.settings);
  std::optional<thermal::Renderer> renderer;
  thermal::Dwell dwell{thermal::DwellLimits{}};  // of the skin, whatever the scene
  std::unique_ptr<thermal::Device> device;
  std::optional<double> element_degC;  // as commanded last, whatever the scene
  std::optional<double> plate_degC;    // as measured last
  thermal_state_t told{};  // last; for who records it
  node.tags().add("skin", "degC", &told.skin_degC);
  node.tags().add("command", "degC", &told.commanded_degC);
  node.tags().add("plate", "degC", [&] { return plate_degC.value_or(told.commanded_degC); });
  node.tags().add("flux", "W/m2", &told.heat_flux_W_m2);
  node.tags().add("force", "N", &told.force_N);
  sync::LiveSettings live(node);
  thermal::Settings own = choice.settings;
  const auto change = [&](const std::string& name, const std::string& value) {
    sync::change_live(choice.settings, own, thermal::setting_fields(), name, value);
    if (renderer) renderer->change(choice.settings);
  };
  if (offline) sense.tell([&](const presentation_t& report) { offline->run().note(declaration.modality, report); });
  node.set_state(node_health_t::WAITING, "waits for the scene");

  while (node.running() && !(offline && offline->run().over())) {
    const sync::HostTime now = offline ? offline->run().next(node.bus()) : node.wait();
    sense.step(now);
    stream.keep(sense.delay());
    while (const auto m = events.pop()) stream.push(m->message, m->arrival);
    while (const auto m = frames.pop()) stream.push(m->message, m->arrival);
    while (const auto m = answers.pop())
      // Not that of a log which is played meanwhile: its plate is not under this finger.
      if (device && m->message.header.run_id == options.run_id) device->receive(m->message, m->arrival);
    if (scenes.poll(now)) {
      choice = thermal::resolve_config(*scenes.scene(), tool_name, options.set);
      for (const std::string& refused : choice.refused) std::cerr << refused << "\n";
      own = choice.settings;
      live.set_scene(*scenes.scene());
      if (offline) offline->run().expect_rate(choice.settings.rate_Hz);
      node.set_rate(choice.settings.rate_Hz);
      quality = thermal::Quality(choice.settings);
      node.set_tool(choice.tool);
      sense.set_scene(*scenes.scene(), choice.tool);
      sense.set_output_latency(sync::from_seconds(1 / choice.settings.rate_Hz) + thermal::Ticks::kSettle);
      node.set_state(node_health_t::WAITING, choice.problem);
      if (renderer) dwell = renderer->dwell();
      renderer.reset();
      device =
          thermal::make_device(choice.settings, choice.tool, plate_degC.value_or(choice.settings.skin_rest_degC));
      if (choice.tool >= 0) {
        renderer.emplace(choice.settings, scenes.scene()->materials, choice.tool, choice.tool_body, element_degC,
                         thermal::thickness_of_bodies(*scenes.scene()));
        renderer->resume(dwell);
      }
    }
    for (const std::string& news : live.step(now, change)) std::cerr << declaration.node << ": " << news << "\n";
    if (!renderer) continue;
    const thermal::Tick tick =
        ticks.next(stream, now, sense.newest_arrival(), choice.tool, choice.tool_body, sense.delay());
    std::optional<sync::ScopedPhaseTimer> rendering(sync::Phase::kRender);
    const double command_degC = element_degC.value_or(choice.settings.skin_rest_degC);
    const auto plate = device ? device->step(command_degC, renderer->load_W(), now) : std::nullopt;
    thermal_state_t state = renderer->step(tick, {.response_s = sense.output().response_s,
                                                  .longest_substep_s = quality.longest_substep_s(),
                                                  .plate = plate});
    rendering.reset();
    told = state;
    element_degC = state.commanded_degC;
    if (offline) offline->add(state);
    node.bus().publish(channels::kThermalState, state);
    if (plate) plate_degC = plate->plate_degC;
    if (plate && device->simulated() && !offline) {
      thermal_device_t answer = thermal::to_message(*plate, choice.tool);
      node.bus().publish(channels::kThermalDevice, answer);
    }
    for (const presentation_t& report : renderer->reports()) sense.report(report);
    sense.publish(now);
    if (!offline) quality.add(sync::host_now() - now);
    node.set_quality(quality.step(), quality.steps());
    node.count_rendered(static_cast<std::int64_t>(renderer->reports().size()));
    if (sense.newest_arrival() == sync::HostTime{})
      node.set_state(node_health_t::READY, "waits for contacts");
    else if (renderer->input_lost())
      node.set_state(node_health_t::INPUT_LOST, "no contacts: the command returns to resting skin");
    else
      node.set_state(node_health_t::RUNNING,
                     device && !plate ? "the display is silent: taken to be as commanded" : "");
    if (offline)
      if (const auto line = offline->run().progress(sync::host_now())) std::cerr << options.name << ": " << *line << std::endl;
  }
  if (offline) {
    const std::string result = offline->result(choice.problem, sync::host_now());
    std::cerr << options.name << ": " << result << std::endl;
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("thermal_node", e);
}
