// Tests of the supervision of nodes by scripts/run: nodes that die are restarted.
#include <nlohmann/json.hpp>
#include <tactus/node_health_t.hpp>

#include "tests/cluster/support/cluster_monitor.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr double kRestartTimeout_s = 60;

// The id of the started run, once it has a recorder. Fails the test with the run's output when there is none in time.
std::int64_t run_id_of(RunScript& run) {
  for (int i = 0; i < 1200; ++i) {
    const std::string address = contents(run.out() / "cluster/address");
    const std::size_t at = address.find("run_id=");
    if (at != std::string::npos && std::filesystem::exists(run.out() / "run.lcmlog"))
      return std::stoll(address.substr(at + 7));
    if (!run.processes.running("run")) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  FAIL("the run does not come up (status " << run.finish(0) << "): " << run.processes.output("run"));
  return 0;
}

}  // namespace

TEST_CASE("DEGRADE-4: every killed node rejoins by itself") {
  RunScript run;
  // Uses the network of this test, so that the test receives the bus.
  run.start({tapping_scene(), "--seconds", "120", "--network", "host", "--out", run.out()});
  ClusterMonitor monitor(run_id_of(run));
  const auto all_running = [&] {
    return std::all_of(kNodes.begin(), kNodes.end(),
                       [&](const auto& n) { return monitor.in_state(n, node_health_t::RUNNING); });
  };
  const bool alive = monitor.wait_until(all_running, kRestartTimeout_s);
  INFO(run.processes.output("run"));
  REQUIRE(alive);

  std::vector<std::string> nodes = kNodes;
  nodes.insert(nodes.end(), {"sync_node", "recorder"});
  for (const std::string& node : nodes) {
    INFO(node);
    run.output_of({"sv", "kill", run.out() / "cluster/services" / node});
    REQUIRE(monitor.wait_until([&] { return monitor.rejoined(node) == 1; }, kRestartTimeout_s));
    REQUIRE(monitor.wait_until(all_running, kRestartTimeout_s));
  }
  const std::int64_t hits = monitor.hits();
  CHECK(monitor.wait_until([&] { return monitor.hits() > hits; }, kRestartTimeout_s));
  for (const std::string& node : nodes) CHECK(monitor.rejoined(node) == 1);

  run.processes.signal("run", SIGINT);
  run.finish(kRestartTimeout_s);
  const auto summary = nlohmann::json::parse(contents(run.out() / "summary.json"), nullptr, false);
  INFO(run.processes.output("run"));
  REQUIRE_FALSE(summary.is_discarded());
  for (const std::string& node : kNodes) {
    INFO(node);
    CHECK(summary["nodes"][node]["restarts"] == 1);
  }
  CHECK(all_processes_ended(5));
}

TEST_CASE("A node that dies repeatedly stays lost and is named, and the others continue") {
  RunScript run;
  run.start(
      {tapping_scene(), "--seconds", "14", "--network", "host", "--without", "visual_node", "--out", run.out()});
  ClusterMonitor monitor(run_id_of(run));
  REQUIRE(monitor.wait_until([&] { return monitor.in_state("thermal_node", node_health_t::RUNNING); }, kRestartTimeout_s));
  const std::filesystem::path service = run.out() / "cluster/services/thermal_node";
  for (int i = 0; i < 200 && !std::filesystem::exists(service / "lost"); ++i) {
    run.processes.spawn("sv", {"sv", "kill", service});
    run.processes.wait_for_exit("sv", 10);
    monitor.receive_for(0.1);
  }
  CHECK(contents(service / "lost").find("left down") != std::string::npos);
  CHECK(monitor.in_state("haptic_node", node_health_t::RUNNING));
  CHECK(monitor.in_state("audio_node", node_health_t::RUNNING));
  CHECK(run.finish(kRestartTimeout_s) == 1);
  CHECK(run.processes.output("run").find("thermal_node: could not be kept running") != std::string::npos);
}

TEST_CASE("tactus attach runs a command in the network of the cluster") {
  RunScript run;
  run.start({tapping_scene(), "--seconds", "40", "--network", "private", "--without", "visual_node", "--out",
             run.out()});
  run_id_of(run);
  const std::string tactus = repository() / "scripts/tactus";
  // A network of its own: the logger there receives the cluster, the test does not.
  const std::string log = run.folder.path() / "heard.lcmlog";
  run.output_of({tactus, "attach", run.out(), "timeout", "3", "lcm-logger", log}, 124);
  CHECK(std::filesystem::file_size(log) > 10000);
  const std::string processes = run.output_of({tactus, "attach", run.out(), "sh", "-c", "cat /proc/[0-9]*/comm"});
  CHECK(processes.find("sim_node") != std::string::npos);
  CHECK(processes.find("cluster_test") == std::string::npos);
  run.output_of({tactus, "attach", run.out(), "pkill", "-KILL", "-x", "thermal_node"});
  // Waits until the supervisor has counted the death: a node that ends while the run is being stopped does not count.
  const std::filesystem::path deaths = run.out() / "cluster/services/thermal_node/deaths";
  for (int i = 0; i < 600 && !std::filesystem::exists(deaths); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  run.processes.signal("run", SIGINT);
  run.finish(kRestartTimeout_s);
  CHECK(run.processes.output("run").find("thermal_node died once") != std::string::npos);
  run.output_of({tactus, "attach", run.out(), "true"}, 1);
}
