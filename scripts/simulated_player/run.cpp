// simulated_player: a simulated player that plays a scene's game with the output of the cluster's modalities, in place of a
// person.
//
//   in   WORLD_STATE, CONTACT_EVENTS   as visual_node and audio_node present them, with the degradations of the profile
//        DEVICE_FORCE                  the force on the hand
//        PLAYOUT, DEGRADATION          the delays and degradations of these modalities; the stage `percept` of touch acts here
//   out  DEVICE_STATE                  the pose of the hand, a thousand times a second
//        DEGRADED                      the decisions of the stage `percept`
//
// When an input is lost, it continues without it. Run it together with haptic_node --device external:player.
#include "scripts/simulated_player/run.h"

#include <cstdio>
#include <optional>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/sim_reply_t.hpp>

#include "scripts/simulated_player/observer_admission.h"
#include "scripts/simulated_player/player_body.h"
#include "scripts/simulated_player/setup.h"
#include "sim_node/scene/scene_folders.h"
#include "sync/node/node.h"
#include "sync/assets/scene_receiver.h"

using namespace tactus;

namespace tactus::simulated_player {
namespace {

const sync::NodeDescriptor kSimulatedPlayer{.name = "participant",
                                        .modality = "",
                                        .rate_Hz = 1000,
                                        .fifo_priority = 55,
                                        .about = "Plays a scene's game in place of a person."};
// Rest position of the hand before the world begins: over the near edge of the dark room.
constexpr double kRest_m[]{-0.2, 0, 0.13};

// The newest force on the hand, while it is valid.
Eigen::Vector3d force_of(const device_force_t& m, sync::HostTime arrival, sync::HostTime now) {
  if (now - arrival > sync::Nanoseconds(m.valid_for_ns)) return Eigen::Vector3d::Zero();
  return {m.force_N.x, m.force_N.y, m.force_N.z};
}

struct PlayerOptions {
  sync::NodeOptions node;
  std::string scene_file, device = "player", player = "stage_model", checks = "require";
  std::vector<std::string> folders;
  Scatter scatter;
  BodyDef body;

  // Reads the command line. Ends the process for --help and wrong options. Throws when the player is unknown or fails its checks.
  void parse(int argc, char** argv);

 private:
  void add_player_to(sync::Arguments&);
};

void PlayerOptions::add_player_to(sync::Arguments& app) {
  app.add_option("--player", player,
                 "stage_model: fixed rules; observer: perceives and moves as a typical person; observer:N: person N of a population")
      .show_default();
  app.add_option("--population", body.population_seed, "seed of the population of --player observer:N").show_default();
  app.add_option("--checks", checks,
                 "for an observer:N that fails one of the twelve checks: require: it does not play; count: it plays, and the checks are named; "
                 "skip: they are not run")
      .show_default();
  app.add_option("--practice", body.practice, "actions whose effects an observer perceived before the game; 0: it does not know the delays")
      .range(0, 100000)
      .show_default();
  app.add_option("--reaction", body.stage_model.reaction_s, "of stage_model: reaction time to sight and hearing, s").range(0.0, 2.0).show_default();
}

void PlayerOptions::parse(int argc, char** argv) {
  sync::Arguments app;
  body.rest_m = {kRest_m[0], kRest_m[1], kRest_m[2]};
  node.add_to(app, kSimulatedPlayer);
  app.add_option("SCENE", scene_file, "SDF file of the world, for the rules of its game").required().existing_file();
  sim::add_scene_folder_option(app, folders);
  app.add_option("--device", device, "name of the device that it controls: haptic_node --device external:NAME").show_default();
  app.add_option("--degrade", node.degrade, "degradation profile (XML) of the observed modalities");
  app.add_option("--frame-rate", body.frame_rate_Hz, "rate of the observed pictures, Hz").range(1.0, 1000.0).show_default();
  app.add_option("--scatter-along", scatter.along_m,
                 "half range of each ball's random start position (from the seed), towards its hole or away, m")
      .range(0.0, 0.2);
  app.add_option("--scatter-aside", scatter.aside_m, "half range of each ball's random start position to the side, m").range(0.0, 0.2);
  add_player_to(app);
  sync::parse_or_exit(app, kSimulatedPlayer.name, argc, argv);
  body.choice = player_choice(player);
  if (const std::vector<int> failed = Admission().admit(body.choice, body.population_seed, check_policy(checks)); !failed.empty())
    std::fprintf(stderr, "simulated_player: %s; its results are not those of a player that is like people\n",
                 failed_sentence(body.choice, body.population_seed, failed).c_str());
}

}  // namespace
}  // namespace tactus::simulated_player

int tactus::simulated_player::run(int argc, char** argv, const Rules* read_before) try {
  PlayerOptions options;
  options.parse(argc, argv);
  const Scatter& scatter = options.scatter;
  const Rules rules = read_before ? *read_before : read_rules(options.scene_file, options.folders);

  sync::Node node(kSimulatedPlayer, options.node);
  sync::SceneReceiver scenes(node.bus());
  auto& forces = node.bus().queue<device_force_t>(channels::kDeviceForce, 64);
  auto& replies = node.bus().queue<sim_reply_t>(channels::kSimReply, 64);
  std::optional<Setup> setup;
  const std::unique_ptr<PlayerBody> body = make_player_body(node, rules, options.body);
  device_state_t state{};
  state.device = options.device;
  device_force_t force{};
  sync::HostTime force_arrival{};
  sync::HostTime last_tick{};
  node.tags().add("goal", "1", [&] { return body->goal(); });
  node.tags().add("doing", "1", [&] { return static_cast<double>(body->action()); });
  node.set_state(node_health_t::WAITING, "waits for the scene");

  while (node.running()) {
    const sync::HostTime now = node.wait();
    while (const auto m = forces.pop())
      if (m->message.device == options.device && m->message.header.run_id == options.node.run_id)
        force = m->message, force_arrival = m->arrival;
    if (scenes.poll(now)) {
      body->set_scene(*scenes.scene());
      setup.emplace(node.bus(), *scenes.scene(), rules, places(rules, *scenes.scene(), scatter, options.node.seed),
                    options.node.seed);
      node.set_state(node_health_t::RUNNING);
    }
    PlayerBody::Tick tick;
    tick.now = now;
    tick.force_N = force_of(force, force_arrival, now);
    // After a late tick the hand moves no further than after one in time.
    tick.dt_s = std::min(2e-3, sync::to_seconds(now - std::exchange(last_tick, now)));
    tick.has_scene = scenes.scene() != nullptr;
    tick.in_setup = setup && (scatter.along_m > 0 || scatter.aside_m > 0) && !setup->done();
    body->step(tick);
    if (tick.in_setup) setup->step(now, replies);
    state.header.sim_time_ns = -1;
    state.pose.position_m = {body->position_m().x(), body->position_m().y(), body->position_m().z()};
    state.pose.orientation.w = 1;
    state.velocity_m_s = {static_cast<float>(body->velocity_m_s().x()), static_cast<float>(body->velocity_m_s().y()),
                          static_cast<float>(body->velocity_m_s().z())};
    state.state = device_state_t::ANSWERS;
    node.bus().publish(channels::kDeviceState, state);
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail(kSimulatedPlayer.name, e);
}
