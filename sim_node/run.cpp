// sim_node: simulates the world at 1 kHz and says, with every step, what touches what.
//
//   in   TOOL_STATE       what each hand does: the force on the bodies is the opposite of what the hand feels
//        NODE_HEALTH      a new process is given every body at once
//        ASSET_REQUEST    chunks of the scene that somebody lacks
//        SIM_COMMAND      pause, step, reset, set, push, snapshot, restore
//   out  TOUCH_MODEL, CONTACT_EVENTS, CONTACTS, WORLD_STATE, GAME_STATE, in this order; SIM_REPLY; SCENE_MANIFEST,
//        ASSET_CHUNK
//
// Losing TOOL_STATE lets go of the bodies within 10 ms. A simulation that cannot keep up keeps its step: its time falls
// behind the clock, and the map that it publishes says so. A world that is reset or put back lives anew: under another
// incarnation, as after a restart, so that no sense keeps what is no more.
#include "sim_node/run.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <utility>

#include "sim_node/world/simulation.h"
#include "sim_node/command/commander.h"
#include "sim_node/dual/followed_rate.h"
#include "sim_node/publish/publisher.h"
#include "sim_node/publish/sim_pacer.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/node/node.h"
#include "sync/assets/scene_exchange.h"

using namespace tactus;

namespace {

sim::Settings settings_of(const sim::WorldDef& world, const std::vector<std::string>& from_command_line) {
  sim::Settings settings;
  const auto refused = sync::apply_settings(settings, sim::setting_fields(), "sim_node", world.settings, from_command_line);
  if (!refused.empty()) throw std::runtime_error(refused.front());
  return settings;
}

// A flood of commands holds no step back; who is not answered repeats.
constexpr int kCommandsPerTick = 4;

// How the world is told of; made anew with each of its lives.
struct Telling {
  Telling(sync::Bus& bus, const sim::Settings& s, sync::Nanoseconds step)
      : publisher(bus, s.state_rate_Hz, s.page_budget, static_cast<std::size_t>(s.event_pages), step) {}
  sim::Publisher publisher;
  sim::SimPacer pacer;
};

const sync::NodeDescriptor kSimulation{.name = "sim_node",
                                       .modality = "",
                                       .rate_Hz = 1000,
                                       .fifo_priority = 50,
                                       .about = "Simulates the world of a scene and publishes its contacts.",
                                       .phases = {sync::Phase::kCollision, sync::Phase::kSolve, sync::Phase::kIntegrate}};

// Publishes the state after a step, or while the simulation is paused (steps: false). due: deadline of this tick, which has no
// jitter, unlike the wake-up.
void publish_state(Telling& telling, sim::Simulation& simulation, bool steps, sync::HostTime due) {
  static const std::vector<contact_event_t> no_events;
  sim::SimPacer& pacer = telling.pacer;
  const sync::TimeMap map = steps ? pacer.tick(simulation.now(), due) : pacer.hold(simulation.now(), due);
  telling.publisher.publish({.time = simulation.now(),
                             .touch_models = &simulation.touch_models(),
                             .events = steps ? &simulation.events() : &no_events,
                             .tool_contacts = &simulation.tool_contacts(),
                             .state = {simulation.bodies(), [&](auto& out) { simulation.body_contacts(out); },
                                       simulation.look_ahead()},
                             .game = &simulation.game()},
                            map);
}

}  // namespace

int tactus::sim::run(int argc, char** argv, const WorldDef* read_before) try {
  CLI::App app;
  sync::NodeOptions options;
  std::string scene;
  options.add_to(app, kSimulation);
  app.add_option("SCENE", scene, "SDF file of the world")->required()->check(CLI::ExistingFile);
  sync::parse_or_exit(app, kSimulation.name, argc, argv);

  std::vector<std::string> warnings;
  const sim::WorldDef world = read_before ? *read_before : sim::load_sdf(scene, warnings);
  for (const std::string& warning : warnings) std::cerr << "sim_node: " << warning << "\n";
  const sim::Settings settings = settings_of(world, options.set);

  sim::Simulation simulation(world, settings);

  sync::Node node(kSimulation, options);
  simulation.start(node.bus().identity().incarnation);
  sync::SceneSender scene_sender(node.bus(), sim::make_assets(world, simulation.step_length().count()));
  std::optional<Telling> telling;
  const auto begin_telling = [&] { telling.emplace(node.bus(), settings, simulation.step_length()); };
  begin_telling();
  sim::Commander commander(simulation, world, options.out);
  auto& tool_states = node.bus().queue<tool_state_t>(channels::kToolState, 64);
  auto& healths = node.bus().queue<node_health_t>(channels::kNodeHealth, 256);
  auto& commands = node.bus().queue<sim_command_t>(channels::kSimCommand, 256);
  bool anew = false;  // the world was reset or put back: it lives again from then on
  sync::HostTime life_begins{};
  std::set<std::int64_t> known;
  sim::FollowedRate followed(settings.visual_follows);
  std::vector<tool_state_t> news;

  node.tags().add("world.time", "s", [&] { return sync::to_seconds(simulation.now().time_since_epoch()); });
  node.tags().add("world.realtime_factor", "1", [&] { return telling->pacer.realtime_factor(); }, 10);
  node.tags().add("contacts.tools", "1", [&] { return static_cast<double>(simulation.tool_contacts().size()); });
  node.tags().add("contacts.events", "1", [&] { return static_cast<double>(simulation.events().size()); });

  // A fixed time: it is nobody in particular that is given it, and nobody is waited for.
  node.set_state(node_health_t::WAITING, "offers the scene; its time has not begun");
  const sync::HostTime begin = sync::host_now() + sync::from_seconds(settings.scene_grace_s);
  for (sync::HostTime now = node.wait(); node.running() && now < begin; now = node.wait()) scene_sender.poll(now);
  node.set_state(node_health_t::RUNNING);
  if (node.running()) std::cerr << "sim_node: the world begins" << std::endl;  // scripts/run counts its seconds from here

  while (node.running()) {
    const sync::HostTime now = node.wait();
    news.clear();
    while (auto m = tool_states.pop())
      if (m->order != sync::Arrival::kOld) news.push_back(std::move(m->message));
    while (const auto m = healths.pop()) {
      if (const auto rate_Hz = followed.on_message(m->message)) {
        simulation.mechanics().set_visual_rate(*rate_Hz);
        std::cerr << "sim_node: visual steps follow " << m->message.node << " at " << *rate_Hz << " Hz" << std::endl;
      }
      if (known.size() < 4096 && known.insert(m->message.header.incarnation).second) telling->publisher.request_full_state();
    }
    for (int left = kCommandsPerTick; left > 0; --left)
      if (const auto m = commands.pop(); m && m->message.header.run_id == options.run_id) commander.execute(m->message);
    for (sim_reply_t& reply : commander.take_replies()) {
      reply.header.sim_time_ns = -1;
      node.bus().publish(channels::kSimReply, reply);
    }
    scene_sender.poll(now);
    if (commander.take_restart()) {
      anew = true;
      life_begins = now + sync::from_seconds(settings.new_life_silence_s);
    }
    if (anew && now < life_begins) continue;
    if (std::exchange(anew, false)) {
      node.begin_incarnation();
      simulation.begin_incarnation(node.bus().identity().incarnation);
      begin_telling();
    }
    const bool steps = commander.step_due();
    steps ? simulation.step(news) : simulation.hold(news);
    publish_state(*telling, simulation, steps, node.deadlines().next() - simulation.step_length());
    node.set_realtime_factor(telling->pacer.realtime_factor());
    node.set_state(node_health_t::RUNNING, commander.paused() ? "the world stands still" : "");
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("sim_node", e);
}
