// Tests of the spy on the bus of a running cluster, in a terminal.
#include <nlohmann/json.hpp>

#include "tests/cluster/support/run_script.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;
using nlohmann::json;

namespace {

const json& channel(const json& all, std::string_view name) {
  for (const json& c : all["channels"])
    if (c["channel"] == name) return c;
  FAIL("no channel " << name);
  return all;
}

}  // namespace

TEST_CASE("spy lists the channels of a running cluster with rates, losses and ages") {
  RunningCluster c;
  c.start();
  const std::string file = c.folder.path() / "spy.json";
  c.processes.spawn(
      "spy", {programs() / "spy", "--run-id", std::to_string(RunningCluster::kRunId), "--once", "3", "--json", file});
  const int status = c.processes.wait_for_exit("spy", kTimeout_s);
  INFO(c.processes.output("spy"));
  REQUIRE(status == 0);
  const json all = json::parse(contents(file), nullptr, false);
  REQUIRE_FALSE(all.is_discarded());
  CHECK(all["lost_here"] == 0);
  const json& tool = channel(all, "TOOL_STATE");
  CHECK(tool["type"] == "tool_state_t");
  CHECK(tool["senders"] == 1);
  // Within a factor of two of its rate: the machine may be busy.
  CHECK(tool["rate_Hz"].get<double>() > 500);
  CHECK(tool["rate_Hz"].get<double>() < 2000);
  CHECK(tool["gaps"] == 0);
  CHECK(tool["age_ms"].get<double>() >= 0);
  CHECK(tool["age_ms"].get<double>() < 1000);
  CHECK(channel(all, "NODE_HEALTH")["senders"].get<int>() >= 6);
  CHECK(channel(all, "WORLD_STATE")["type"] == "world_state_t");
  CHECK_THAT(c.processes.output("spy"), Catch::Contains("TOOL_STATE") && Catch::Contains("kB/s"));
}

TEST_CASE("In a terminal keys of spy show the fields of a channel and the variables of all nodes, and quitting restores the terminal") {
  RunningCluster c;
  c.start();
  const std::string typescript = c.folder.path() / "typescript";
  const std::string spy = (programs() / "spy").string() + " --run-id " + std::to_string(RunningCluster::kRunId);
  // Keys: down to TOOL_STATE, enter; back; variables; end.
  c.processes.spawn("spy", {"sh", "-c",
                            "(sleep 3; for i in $(seq 60); do printf j; sleep 0.01; done; sleep 1; printf k; "
                            "sleep 1; printf '\\r'; sleep 2; "
                            "printf h; sleep 1; printf t; sleep 4; printf q; sleep 1) | "
                            "script -qfec 'stty cols 150 rows 50; exec " +
                                spy + "' " + typescript});
  const int status = c.processes.wait_for_exit("spy", kTimeout_s);
  const std::string seen = contents(typescript);
  INFO(seen.substr(seen.size() > 6000 ? seen.size() - 6000 : 0));
  CHECK(status == 0);
  CHECK_THAT(seen, Catch::Contains("TOOL_STATE") && Catch::Contains("jitter"));
  CHECK_THAT(seen, Catch::Contains("the newest message"));
  CHECK_THAT(seen, Catch::Contains("haptic_node.force") && Catch::Contains("sim_node.work.collision"));
  CHECK_THAT(seen, Catch::Contains("\033[?1049h") && Catch::Contains("\033[?1049l"));
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}

TEST_CASE("Without a terminal or without messages, spy reports it in one sentence", "[smoke]") {
  RunningCluster c;
  c.processes.spawn("none", {programs() / "spy"});
  CHECK(c.processes.wait_for_exit("none", 20) == 1);
  CHECK_THAT(c.processes.output("none"), Catch::Contains("--once"));
  c.processes.spawn("silent", {programs() / "spy", "--once", "0.5"});
  CHECK(c.processes.wait_for_exit("silent", 20) == 1);
  CHECK_THAT(c.processes.output("silent"), Catch::Contains("received no message on port"));
}
