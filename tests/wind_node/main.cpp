// wind_node: a fan that blows what passes the head and a gust for every hit, at 50 Hz.
//
//   in   WORLD_STATE, CONTACT_EVENTS   where the bodies are and how they move, what hit
//        SCENE_MANIFEST, ASSET_CHUNK   the scene: sizes of bodies, where the head is
//   out  PRESENTED                     every hit
//        wind.csv                      every tick
//
// Losing WORLD_STATE lets the wind die away; the loop never waits for another node.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "sync/node/node.h"
#include "sync/assets/scene_exchange.h"
#include "sync/node/modality_endpoint.h"
#include "tests/wind_node/fan.h"

using namespace tactus;

int main(int argc, char** argv) try {
  wind::Settings settings;
  const sync::NodeDescriptor declaration{.node = "wind_node",
                                      .modality = "wind",
                                      .owes = int{node_health_t::OWES_HIT},
                                      .rate_Hz = settings.rate_Hz,
                                      .about = "Blows what passes the head, and a gust for every hit.",
                                      .inputs = {channels::kWorldState, channels::kContactEvents},
                                      .presents = "the tick whose command begins the gust",
                                      .late = sync::Late::kShowNewest,
                                      .degradable = {"response"}};
  CLI::App app;
  sync::NodeOptions options;
  options.add_to(app, declaration);
  sync::parse_or_exit(app, declaration.node, argc, argv);
  for (const std::string& wrong : sync::apply_settings(settings, wind::setting_fields(), declaration.node,
                                                       std::vector<setting_t>{}, options.set))
    throw std::runtime_error(wrong);

  sync::Node node(declaration, options);
  node.set_rate(settings.rate_Hz);
  sync::SceneReceiver scenes(node.bus());
  sync::ModalityEndpoint sense(node);
  auto& world = sense.snapshots<world_state_t>(channels::kWorldState, 4096);
  auto& events = sense.events();
  std::optional<wind::Fan> fan;
  std::ofstream table(options.out + "/wind.csv");
  table << "host_ns,wind_m_s,gust,fan_share\n";
  node.set_state(node_health_t::WAITING, "waits for the scene");

  while (node.running()) {
    const sync::HostTime now = node.wait();
    sense.step(now);
    if (scenes.poll(now)) {
      sense.set_scene(*scenes.scene());
      sense.set_output_latency(sync::from_seconds(1 / settings.rate_Hz));
      fan.emplace(settings, *scenes.scene(), node.bus().clocks());
    }
    if (!fan) continue;
    while (const auto m = world.pop()) fan->push(m->message, m->arrival);
    while (const auto m = events.pop()) fan->push(m->message, m->arrival);
    const auto state =
        fan->step(now, sense.delay(), sense.output().response_s,
                  [&](std::int64_t id, sync::HostTime happened) { return sense.schedule(id, happened); });
    table << sync::to_ns(now) << "," << state.wind_m_s << "," << state.gust << "," << state.share << "\n";
    for (const presentation_t& report : fan->reports()) sense.report(report);
    sense.publish(now);
    node.count_rendered(static_cast<std::int64_t>(fan->reports().size()));
    const bool begun = sense.newest_arrival() != sync::HostTime{};
    const bool lost = now - sense.newest_arrival() > sync::BodyHistory::kStaleAfter;
    node.set_state(!begun ? node_health_t::READY
                   : lost ? node_health_t::INPUT_LOST
                          : node_health_t::RUNNING,
                   !begun ? "waits for the world"
                   : lost ? "no world: the wind dies away"
                          : "");
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("wind_node", e);
}
