// Tests of two hosts with different clocks: the clocks are mapped, and presentations of one host are matched on the other.
#include <nlohmann/json.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/pair_report_t.hpp>
#include <tactus/sync_report_t.hpp>

#include "tests/cluster/support/run_script.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;
using nlohmann::json;

namespace {

// Runs a command in a time namespace whose clock is an hour ahead: another host, as far as clocks are concerned.
std::vector<std::string> with_clock_ahead(std::vector<std::string> command) {
  const std::vector<std::string> host{"unshare", "--time", "--monotonic", "3600", "--fork", "--kill-child"};
  command.insert(command.begin(), host.begin(), host.end());
  return command;
}

bool has_time_namespaces(RunScript& run) {
  run.processes.spawn("probe", with_clock_ahead({"true"}));
  return run.processes.wait_for_exit("probe", 20) == 0;
}

// Starts one scenario of tests/measure/measure_clocks. Each has network namespaces of its own, so they run side by side.
void start_scenario(RunScript& run, const std::string& scenario) {
  run.processes.spawn(scenario, {"env", "TACTUS_BIN=" + programs().string(), (repository() / "tests/measure/measure_clocks").string(),
                                 "--seconds", "16", "--only", scenario, "--json", run.folder.path() / (scenario + ".json")});
}

// The figures of a scenario; null where this machine has no time namespaces.
json figures_of(RunScript& run, const std::string& scenario) {
  const int status = run.processes.wait_for_exit(scenario, 90);
  UNSCOPED_INFO(run.processes.output(scenario));
  if (status == 77) return {};
  const json rows = json::parse(contents(run.folder.path() / (scenario + ".json")), nullptr, false);
  REQUIRE(rows.is_array());
  REQUIRE(rows.size() == 1);
  return rows[0];
}

}  // namespace

TEST_CASE(
    "The clock maps of two hosts contain the true offset: idle, drifting, delayed in one direction, "
    "jumping, replaced") {
  const std::vector<std::string> scenarios{"idle", "drift", "held", "jump", "restart"};
  RunScript run;
  for (const std::string& scenario : scenarios) start_scenario(run, scenario);
  for (const std::string& scenario : scenarios) {
    const json row = figures_of(run, scenario);
    if (row.is_null()) return;
    INFO(row.dump());
    REQUIRE(row["n"].get<int>() > 20);
    CHECK(row["within"].get<double>() >= 0.99);
    CHECK(row["uncertainty_us"]["50"].get<double>() < 20'000);
    if (scenario == "held") CHECK(row["uncertainty_us"]["50"].get<double>() > 1'000);
    CHECK(row["clocks"].get<int>() == (scenario == "restart" ? 2 : 1));
    CHECK(row["epochs"].get<int>() == (scenario == "jump" ? 2 : 1));
  }
}

TEST_CASE("A modality on a host whose clock is an hour ahead presents all expected events and reports correct ages") {
  RunScript run;
  if (!has_time_namespaces(run)) return;
  RunningCluster r;
  // Both processes share one time namespace: each namespace is a clock of its own, and a host has one sync_node.
  const std::string common = " --run-id " + std::to_string(RunningCluster::kRunId) + " --out " + quoted(r.folder.path());
  const std::string remote = quoted(programs() / "sync_node") + common + " --name sync_node_there & exec " +
                            quoted(programs() / "visual_node") + common;
  r.processes.spawn("visual_node", with_clock_ahead({"sh", "-c", remote}));
  auto& reports = r.monitor.bus().queue<sync_report_t>(channels::kSyncReport, 64);
  r.processes.start("sync_node");
  r.processes.start("audio_node");
  r.processes.start("haptic_node");
  r.processes.start("sim_node", {tapping_scene()});
  const auto source = static_cast<std::int32_t>(sync::fnv1a_32("sync_node"));
  std::optional<pair_report_t> pair;
  const auto has_pair = [&] {
    while (const auto m = reports.pop())
      for (const pair_report_t& p : m->message.pairs)
        if (m->message.header.source == source && p.a == "audio" && p.b == "visual" && p.n > 20) pair = p;
    return pair.has_value();
  };
  const bool presented = r.monitor.wait_until(has_pair, kTimeout_s);
  INFO(r.log_text());
  REQUIRE(presented);
  // The wrong clock would give half an hour; a slow machine gives half a second.
  CHECK(std::abs(pair->p50_ns) < 500'000'000);
  CHECK(pair->uncertainty_ns > 1'000);
  const node_health_t* health = r.monitor.health("visual_node");
  REQUIRE(health);
  bool has_age = false;
  for (const input_health_t& in : health->inputs) {
    if (in.channel != channels::kWorldState) continue;
    has_age = true;
    CHECK(in.uncertainty_ns > 0);
    CHECK(in.age_ns < 5'000'000'000);
  }
  CHECK(has_age);
}
