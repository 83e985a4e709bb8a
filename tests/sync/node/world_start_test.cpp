// Tests of the begin of a world: it waits for the scene of every process, for a bounded time, in any order of their
// starts.
#include "sync/node/world_start.h"

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/assets/scene_receiver.h"
#include "sync/assets/scene_sender.h"
#include "sync/bus/bus.h"
#include "sync/bus/decode.h"
#include "sync/clocks/pacing.h"
#include "sync/node/node.h"
#include "sync/random/keyed_random.h"
#include "sync/virtual_time/virtual_time.h"

using namespace tactus;
using namespace tactus::sync;
using namespace std::chrono_literals;

namespace {

constexpr std::int64_t kRun = 7;

node_health_t report(const std::string& name, std::int8_t state, const std::string& text = "", const std::string& modality = "audio",
                     std::int64_t run = kRun) {
  node_health_t m{};
  m.header.run_id = run;
  m.node = name;
  m.modality = modality;
  m.state = state;
  m.status_text = text;
  return m;
}

WorldStart start(std::vector<std::string> awaited) {
  return WorldStart({.awaited = std::move(awaited), .run_id = kRun, .min_wait = 500ms, .max_wait = 10s}, host_time(0));
}

std::vector<Asset> assets_of_scene(std::size_t mesh_bytes) {
  scene_t s{};
  s.step_ns = 1'000'000;
  s.camera.orientation.w = s.listener.orientation.w = 1;
  s.camera_fov_rad = 1;
  return {{asset_ref_t::SCENE, "scene", encode(s)}, {asset_ref_t::MESH, "mesh", Bytes(mesh_bytes, 3)}};
}

NodeOptions options_of(const std::string& name) {
  NodeOptions options;
  options.name = name, options.run_id = kRun, options.realtime = "off";
  return options;
}

// A modality that loads its scene in some of its ticks.
int render(const std::string& name, double rate_Hz, int loads_ticks, HostTime& ready_at) {
  Node node({.name = name, .modality = name, .rate_Hz = rate_Hz, .about = ""}, options_of(name));
  SceneReceiver scenes(node.bus());
  int left = loads_ticks;
  while (node.running()) {
    const HostTime now = node.wait();
    scenes.poll(now);
    if (!scenes.scene() || left-- > 0) continue;
    if (ready_at == HostTime{}) ready_at = now;
    node.set_state(node_health_t::READY);
  }
  return 0;
}

// The simulation, until its world begins.
int simulate(std::vector<std::string> awaited, std::size_t mesh_bytes, HostTime& begins_at) {
  Node node({.name = "sim_node", .modality = "", .rate_Hz = 1000, .about = ""}, options_of("sim_node"));
  SceneSender sender(node.bus(), assets_of_scene(mesh_bytes));
  auto& healths = node.bus().queue<node_health_t>(channels::kNodeHealth, 256);
  WorldStart begin({.awaited = std::move(awaited), .run_id = kRun, .min_wait = 500ms, .max_wait = 10s}, host_now());
  while (node.running()) {
    const HostTime now = node.wait();
    while (const auto m = healths.pop()) begin.observe(m->message);
    if (begin.due(now)) break;
    sender.poll(now, SceneSender::kOfferPeriod);
  }
  begins_at = host_now();
  return 0;
}

}  // namespace

TEST_CASE("A world without other processes begins after its shortest wait") {
  const WorldStart world = start({});
  CHECK_FALSE(world.due(host_time(499'999'999)));
  CHECK(world.due(host_time(500'000'000)));
  CHECK(world.late().empty());
}

TEST_CASE("A world waits for a named process from the start, and for any other modality once it reports") {
  WorldStart named = start({"audio_node"});
  CHECK_FALSE(named.due(host_time(9'000'000'000)));
  CHECK(named.late() == "audio_node (no report yet)");
  named.observe(report("audio_node", node_health_t::WAITING, "opens its card; SCHED_FIFO 60"));
  CHECK(named.late() == "audio_node (opens its card)");
  named.observe(report("audio_node", node_health_t::READY));
  CHECK(named.due(host_time(500'000'000)));
  named.observe(report("visual_node", node_health_t::WAITING, "prepares the pictures of the scene"));
  CHECK_FALSE(named.due(host_time(500'000'000)));
  CHECK(named.late() == "visual_node (prepares the pictures of the scene)");
  named.observe(report("visual_node", node_health_t::RUNNING));
  CHECK(named.due(host_time(500'000'000)));
}

TEST_CASE("A world begins at its longest wait without the processes that are not ready") {
  WorldStart world = start({"audio_node"});
  world.observe(report("visual_node", node_health_t::WAITING));
  CHECK_FALSE(world.due(host_time(10'499'999'999)));
  CHECK(world.due(host_time(10'500'000'000)));
  CHECK(world.late() == "audio_node (no report yet), visual_node");
}

TEST_CASE("A process that cannot become ready delays no world") {
  for (const std::int8_t state : {node_health_t::OUTPUT_LOST, node_health_t::INPUT_LOST, node_health_t::STALE}) {
    WorldStart world = start({"audio_node"});
    world.observe(report("audio_node", state));
    CHECK(world.due(host_time(500'000'000)));
  }
}

TEST_CASE("Other runs, programs without a modality and a flood of names delay no world") {
  WorldStart world = start({});
  world.observe(report("audio_node", node_health_t::WAITING, "", "audio", 8));
  world.observe(report("display_program", node_health_t::WAITING, "", ""));
  CHECK(world.due(host_time(500'000'000)));
  for (int i = 0; i < 10'000; ++i) world.observe(report("n" + std::to_string(i), node_health_t::WAITING));
  CHECK(world.late().size() < 10 * WorldStart::kMaxNodes);
  CHECK(world.due(host_time(10'500'000'000)));
}

// Random starts: order and phase of the programs from the seed, rates, load times, scene sizes, latency and loss of the bus.
TEST_CASE("A world begins when every modality has its scene, for every seed, rate, bus and order of starting") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    VirtualPlan plan{.seed = seed};
    std::uint64_t drawn = seed * 1000;
    const auto draw = [&drawn] { return uniform(99, ++drawn); };
    plan.wire.latency = from_seconds(0.02 * draw());
    plan.wire.loss.share = seed % 3 == 0 ? 0.2 * draw() : 0;
    const std::size_t mesh_bytes = 1 + static_cast<std::size_t>(300'000 * draw());
    HostTime begins_at{};
    std::vector<HostTime> ready(4);
    const std::vector<std::string> names{"haptic", "audio", "visual", "thermal"};
    const std::vector<std::string> awaited = seed % 2 ? names : std::vector<std::string>{};
    VirtualTime time(plan);
    const std::size_t sim_at = static_cast<std::size_t>(5 * draw());
    for (std::size_t i = 0; i <= names.size(); ++i) {
      if (i == sim_at) time.add("sim", [&] { return simulate(awaited, mesh_bytes, begins_at); });
      if (i == names.size()) break;
      const double rate_Hz = 20 + 980 * draw();
      const int loads_ticks = static_cast<int>(2 * rate_Hz * draw());  // up to 2 s
      time.add(names[i], [&ready, &names, i, rate_Hz, loads_ticks] { return render(names[i], rate_Hz, loads_ticks, ready[i]); });
    }
    time.run_for(9s);
    INFO("seed " << seed);
    REQUIRE(begins_at != HostTime{});
    for (const HostTime at : ready) {
      REQUIRE(at != HostTime{});
      CHECK(at <= begins_at);
    }
    time.end();
  }
}
