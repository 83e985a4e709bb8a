// sim_node: simulates the world at 1 kHz and publishes the contacts of every step.
//
//   in   TOOL_STATE       proxy and force of each hand; the bodies receive the opposite force
//        NODE_HEALTH      a new process receives every body immediately
//        ASSET_REQUEST    chunks of the scene that a process lacks
//        SIM_COMMAND      pause, step, reset, set, push, snapshot, restore
//        DEGRADATION      the profile; its stage `action` delays TOOL_STATE here
//   out  TOUCH_MODEL, CONTACT_EVENTS, CONTACTS, WORLD_STATE, GAME_STATE, in this order; SIM_REPLY; SCENE_MANIFEST,
//        ASSET_CHUNK; DEGRADED of the stage `action`
//
// When TOOL_STATE is lost, the forces on the bodies fade within 10 ms. A tool has one sender: a second haptic process, and a
// second simulation of the run, are named in the health and change nothing. A simulation that cannot keep up keeps its
// step length: simulated time falls behind the clock, and the published map shows the speed. A world that is reset
// or restored continues under another incarnation, as after a restart, so that no receiver keeps obsolete
// contacts.
#include "sim_node/run.h"

#include <iostream>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <utility>

#include "sim_node/world/simulation.h"
#include "sim_node/command/command_queue.h"
#include "sim_node/command/commander.h"
#include "sim_node/dual/followed_rate.h"
#include "sim_node/world/engine.h"
#include "sim_node/publish/known_processes.h"
#include "sim_node/publish/publisher.h"
#include "sim_node/publish/sim_pacer.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_assets.h"
#include "sim_node/scene/scene_folders.h"
#include "sim_node/touch/late_hand.h"
#include "sim_node/touch/tool_senders.h"
#include "sync/degradation/known_modalities.h"
#include "sync/node/modality_endpoint.h"
#include "sync/node/node.h"
#include "sync/sandbox/sandbox.h"
#include "sync/node/world_start.h"
#include "sync/text/printable.h"
#include "sync/assets/scene_sender.h"

using namespace tactus;

namespace {

sim::Settings settings_of(const sim::WorldDef& world, const std::vector<std::string>& from_command_line) {
  sim::Settings settings;
  const auto errors =
      sync::apply_settings(settings, sim::setting_fields(), "sim_node", world.settings, from_command_line);
  if (!errors.empty()) throw std::runtime_error(errors.front());
  if (const std::string error = sim::apply_engine(settings); !error.empty()) throw std::runtime_error(error);
  return settings;
}

// One line for the health: a pause, and outputs with two senders. Empty: nothing to report.
std::string status_of(const sim::Commander& commander, const sim::ToolSenders& senders, const sim::KnownProcesses& processes,
                      sync::HostTime now) {
  std::string text = commander.paused() ? "the world stands still" : "";
  for (const std::string& part : {senders.conflict_text(now), processes.conflict_text(now)})
    if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
  return text;
}

// Publisher and clock map of one incarnation of the world.
struct WorldPublisher {
  WorldPublisher(sync::Bus& bus, const sim::Settings& s, sync::Nanoseconds step)
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

// The hands as the world receives them: one sender for each tool, late by the stage `action` of the profile in force.
class Hands {
 public:
  Hands(sync::Node& node, const sim::WorldDef& world)
      : queue_(node.bus().queue<tool_state_t>(channels::kToolState, 64)),
        senders_(world.tools, node.options().run_id),
        endpoint_(node, {.name = kSimulation.name, .modality = modality(), .about = ""}),
        stage_(endpoint_.stage(kStage)) {
    endpoint_.set_scene_profile(world.profile);
  }

  // The messages that reach the world by now, in order; valid until the next call. time: of the world.
  const std::vector<tool_state_t>& receive(sync::HostTime now, sync::SimTime time) {
    endpoint_.step(now);
    sync::HostTime received = now;  // also accepts the messages that arrive while it reads
    while (auto m = queue_.pop()) {
      received = std::max(received, m->arrival);
      if (senders_.accept(m->message, m->arrival)) late_.push(std::move(m->message), m->arrival, stage_.operators, &stage_.decisions);
    }
    released_.clear();
    late_.release(received, time, stage_.operators, released_);
    endpoint_.publish(now);
    return released_;
  }
  const sim::ToolSenders& senders() const { return senders_; }

 private:
  static constexpr const char* kStage = "action";
  static std::string modality() {
    const sync::KnownModality* known = sync::modality_with_stage(kStage);
    return known ? known->name : "";
  }

  sync::Queue<tool_state_t>& queue_;
  sim::ToolSenders senders_;
  sync::ModalityEndpoint endpoint_;
  sync::ModalityEndpoint::Stage& stage_;
  sim::LateHand late_;
  std::vector<tool_state_t> released_;
};

// Publishes the state after a step, or while the simulation is paused (steps: false). due: deadline of this tick, which has no
// jitter, unlike the wake-up.
void publish_state(WorldPublisher& world_publisher, sim::Simulation& simulation, bool steps, sync::HostTime due) {
  static const std::vector<contact_event_t> no_events;
  sim::SimPacer& pacer = world_publisher.pacer;
  const sync::TimeMap map = steps ? pacer.tick(simulation.now(), due) : pacer.hold(simulation.now(), due);
  world_publisher.publisher.publish(
      {.time = simulation.now(),
       .touch_models = &simulation.touch_models(),
       .events = steps ? &simulation.events() : &no_events,
       .tool_contacts = &simulation.tool_contacts(),
       .state = {simulation.bodies(), [&](auto& out) { simulation.body_contacts(out); }, simulation.look_ahead()},
       .game = &simulation.game()},
      map);
}

// Offers the scene until every awaited process has it, for a bounded time.
void offer_scene(sync::Node& node, sync::SceneSender& sender, sync::Queue<node_health_t>& healths, const sync::WorldStartDef& def) {
  sync::WorldStart start(def, sync::host_now());
  const sync::HostTime announce = sync::host_now() + def.min_wait;
  bool announced = false;
  for (sync::HostTime now = node.wait(); node.running() && !start.due(now); now = node.wait()) {
    while (const auto m = healths.pop()) start.observe(m->message);
    sender.poll(now, sync::SceneSender::kOfferPeriod);
    const std::string late = sync::printable(start.late());
    node.set_state(node_health_t::WAITING, "waits for " + (late.empty() ? "other processes to load the scene" : late));
    if (now >= announce && !late.empty() && !std::exchange(announced, true))
      std::cerr << "sim_node: waits for " << late << std::endl;
  }
  node.set_state(node_health_t::RUNNING);
  if (!node.running()) return;
  if (const std::string late = start.late(); !late.empty())
    std::cerr << "sim_node: begins the world without " << sync::printable(late) << ": not ready after "
              << sync::to_seconds(def.min_wait + def.max_wait) << " s; its first events are missed. Increase ready_timeout" << std::endl;
  std::cerr << "sim_node: the world begins" << std::endl;  // scripts/run measures its duration from here
}

void add_tags(sync::Tags& tags, const sim::Simulation& simulation, const std::optional<WorldPublisher>& publisher) {
  tags.add("world.time", "s", [&] { return sync::to_seconds(simulation.now().time_since_epoch()); });
  tags.add("world.realtime_factor", "1", [&] { return publisher->pacer.realtime_factor(); }, 10);
  tags.add("contacts.tools", "1", [&] { return static_cast<double>(simulation.tool_contacts().size()); });
  tags.add("contacts.events", "1", [&] { return static_cast<double>(simulation.events().size()); });
}

// Prints a missing confinement of its readers, and the warnings about the scene. Raises its errors.
sim::WorldDef read_world(const std::string& scene, const std::vector<std::string>& folders) {
  if (const std::string notice = sync::confinement_notice(sync::available_confinement()); !notice.empty())
    std::cerr << "sim_node: " << notice << "\n";
  std::vector<std::string> warnings;
  sim::WorldDef world = sim::load_sdf(scene, warnings, {.folders = sim::scene_folders(folders)});
  for (const std::string& warning : warnings) std::cerr << "sim_node: " << sync::printable(warning) << "\n";
  return world;
}

}  // namespace

int tactus::sim::run(int argc, char** argv, const WorldDef* loaded_world) try {
  sync::Arguments app;
  sync::NodeOptions options;
  std::string scene;
  std::vector<std::string> folders, awaited;
  options.add_to(app, kSimulation);
  app.add_option("SCENE", scene, "SDF file of the world").required().existing_file();
  sim::add_scene_folder_option(app, folders);
  app.add_option("--await", awaited, "name of a process that must have its scene before the world begins, once for each").one_value_per_use();
  app.add_option("--degrade", options.degrade, "degradation profile (XML); its stage action delays the hands on their way to the world");
  sync::parse_or_exit(app, kSimulation.name, argc, argv);

  const sim::WorldDef world = loaded_world ? *loaded_world : read_world(scene, folders);
  const sim::Settings settings = settings_of(world, options.set);
  sim::Simulation simulation(world, settings);
  sync::Node node(kSimulation, options);
  simulation.start(node.bus().identity().incarnation);
  sync::SceneSender scene_sender(node.bus(), sim::make_assets(world, simulation.step_length().count()));
  std::optional<WorldPublisher> world_publisher;
  const auto start_publishing = [&] { world_publisher.emplace(node.bus(), settings, simulation.step_length()); };
  start_publishing();
  sim::Commander commander(simulation, world, options.out);
  auto& healths = node.bus().queue<node_health_t>(channels::kNodeHealth, 256);
  auto& commands = node.bus().queue<sim_command_t>(channels::kSimCommand, 256);
  bool restart_pending = false;  // the world was reset or restored and continues at restart_time
  sync::HostTime restart_time{};
  sim::KnownProcesses processes(options.name, options.run_id);
  processes.add_own(node.bus().identity().incarnation);
  Hands hands(node, world);
  sim::FollowedRate followed_rate(settings.visual_follows);

  add_tags(node.tags(), simulation, world_publisher);

  offer_scene(node, scene_sender, healths,
              {.awaited = awaited,
               .run_id = options.run_id,
               .min_wait = sync::from_seconds(settings.scene_grace_s),
               .max_wait = sync::from_seconds(settings.ready_timeout_s)});

  while (node.running()) {
    const sync::HostTime now = node.wait();
    const std::vector<tool_state_t>& new_messages = hands.receive(now, simulation.now());
    while (const auto m = healths.pop()) {
      if (m->message.header.run_id != options.run_id) continue;
      if (const auto rate_Hz = followed_rate.on_message(m->message, m->arrival)) {
        simulation.mechanics().set_visual_rate(*rate_Hz);
        std::cerr << "sim_node: visual steps follow " << m->message.node << " at " << *rate_Hz << " Hz" << std::endl;
      }
      if (!processes.is_new(m->message, m->arrival)) continue;
      world_publisher->publisher.request_full_state();
      scene_sender.announce_soon();
    }
    sim::execute_commands(commands, commander, options.run_id);
    for (sim_reply_t& reply : commander.take_replies()) {
      reply.header.sim_time_ns = -1;
      node.bus().publish(channels::kSimReply, reply);
    }
    scene_sender.poll(now);
    if (commander.take_restart()) {
      restart_pending = true;
      restart_time = now + sync::from_seconds(settings.restart_silence_s);
    }
    if (restart_pending && now < restart_time) continue;
    if (std::exchange(restart_pending, false)) {
      node.begin_incarnation();
      processes.add_own(node.bus().identity().incarnation);
      simulation.begin_incarnation(node.bus().identity().incarnation);
      start_publishing();
    }
    const bool steps = commander.step_due();
    steps ? simulation.step(new_messages) : simulation.hold(new_messages);
    publish_state(*world_publisher, simulation, steps, node.deadlines().next() - simulation.step_length());
    node.set_realtime_factor(world_publisher->pacer.realtime_factor());
    node.set_state(node_health_t::RUNNING, status_of(commander, hands.senders(), processes, now));
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("sim_node", e);
}
