// Tests of stopped, frozen, killed and late nodes in a running cluster: the other nodes keep their rates.
#include <signal.h>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/tool_constraint_t.hpp>

#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

std::vector<std::string> without(const std::string& node) {
  std::vector<std::string> rest = kNodes;
  std::erase(rest, node);
  return rest;
}

// Ids carry 24 bits of the incarnation of the simulation that assigned them.
bool of_incarnation(std::int64_t id, std::int64_t incarnation) {
  return id >> 40 == sync::prefixed_id(incarnation, 0) >> 40;
}

}  // namespace

TEST_CASE("DEGRADE-1: with audio_node stopped the others keep their rates") {
  RunningCluster c;
  c.start();
  const auto before = c.rates(2);
  c.processes.signal("audio_node", SIGTERM);
  CHECK(c.processes.wait_for_exit("audio_node", kTimeout_s) == 0);
  const std::int64_t hits = c.monitor.hits(), felt = c.monitor.rendered("haptic_node"),
                     seen = c.monitor.rendered("visual_node");
  c.check_rates_hold(before, 3, "audio_node");
  CHECK(c.monitor.wait_until([&] { return c.monitor.health("audio_node") == nullptr; }, kTimeout_s));
  CHECK(c.monitor.wait_until([&] { return c.all_running(without("audio_node")); }, kTimeout_s));
  CHECK(c.monitor.wait_until([&] { return c.monitor.hits() > hits; }, kTimeout_s));
  CHECK(c.monitor.wait_until([&] { return c.monitor.rendered("haptic_node") > felt; }, kTimeout_s));
  CHECK(c.monitor.wait_until([&] { return c.monitor.rendered("visual_node") > seen; }, kTimeout_s));
}

TEST_CASE("DEGRADE-2: visual_node, frozen for 2 s, disturbs no other node and then shows the present state") {
  RunningCluster c;
  c.start();
  const std::int64_t stale_at_start = c.monitor.newest_health("visual_node").stale_ticks;
  const auto before = c.rates(2);
  // Heavy load alone makes some inputs stale: if their number is the same as before the freeze, the freeze has no
  // effect.
  const std::int64_t stale = c.monitor.newest_health("visual_node").stale_ticks;
  const std::int64_t usual = stale - stale_at_start;
  const std::int64_t frames = c.monitor.ticks("visual_node");
  const std::int64_t missed = c.monitor.newest_health("visual_node").missed_ticks;
  c.processes.signal("visual_node", SIGSTOP);
  c.check_rates_hold(before, 2, "visual_node");
  CHECK(c.monitor.wait_until([&] { return c.monitor.health("visual_node") == nullptr; }, kTimeout_s));
  c.processes.signal("visual_node", SIGCONT);

  REQUIRE(c.monitor.wait_until([&] { return c.is_running("visual_node"); }, kTimeout_s));
  c.monitor.receive_for(1);
  const node_health_t* h = c.monitor.health("visual_node");
  REQUIRE(h != nullptr);
  CHECK(h->ticks > frames);
  // Two frames, and more beside heavy load; a node that worked through its backlog would be stale for two seconds.
  CHECK(h->stale_ticks - stale <= 30 + usual);
  // The node skipped the missed frames: two seconds at its rate.
  CHECK(h->missed_ticks - missed > before.at("visual_node"));
  CHECK(c.monitor.wait_until([&] { return c.receives_the_present("visual_node"); }, kTimeout_s));
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}

TEST_CASE("DEGRADE-3: when sim_node dies the force fades, all nodes report it and resume, and no old contact remains") {
  RunningCluster c;
  c.start();
  REQUIRE(c.monitor.wait_until([&] { return c.monitor.force_N() > 0; }, kTimeout_s));
  REQUIRE(c.monitor.wait_until([&] { return !c.monitor.contact_ids().empty(); }, kTimeout_s));
  const std::int64_t first = c.monitor.newest_health("sim_node").header.incarnation;
  c.processes.kill("sim_node");

  CHECK(c.monitor.wait_until([&] { return c.monitor.force_N() == 0 && c.monitor.tool_state()->fade == 0; }, 5));
  for (const std::string& node : kModalityNodes) {
    INFO(node);
    CHECK(c.monitor.wait_until(
        [&] { return c.state(node, node_health_t::INPUT_LOST) || c.state(node, node_health_t::STALE); },
        kTimeout_s));
  }
  c.monitor.receive_for(1);
  for (const std::string& node : kModalityNodes) {
    INFO(node << ": " << c.processes.output(node));
    CHECK(c.processes.running(node));
  }
  CHECK(c.monitor.force_N() == 0);

  c.processes.start("sim_node", {tapping_scene()});
  REQUIRE(c.monitor.wait_until([&] { return c.monitor.rejoined("sim_node") == 1 && c.is_running("sim_node"); }, kTimeout_s));
  const std::int64_t second = c.monitor.newest_health("sim_node").header.incarnation;
  REQUIRE(second != first);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
  CHECK(c.monitor.wait_until([&] { return c.monitor.force_N() > 0; }, kTimeout_s));
  for (const tool_constraint_t& constraint : c.monitor.tool_state()->constraints)
    CHECK(of_incarnation(constraint.contact_id, second));
  CHECK(c.monitor.wait_until([&] { return !c.monitor.contact_ids().empty(); }, kTimeout_s));
  for (const std::int64_t id : c.monitor.contact_ids()) CHECK(of_incarnation(id, second));
  UNSCOPED_INFO(c.log_text());
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}

TEST_CASE("A node that joins late receives the scene without a restart of other nodes") {
  RunningCluster c;
  const std::string late = GENERATE(as<std::string>{}, "haptic_node", "audio_node", "visual_node", "thermal_node");
  c.processes.start("sim_node", {tapping_scene()});
  REQUIRE(c.monitor.wait_until([&] { return c.is_running("sim_node"); }, kTimeout_s));
  c.monitor.receive_for(1);
  c.processes.start(late);
  const bool joined = c.monitor.wait_until([&] { return c.is_running(late); }, kTimeout_s);
  INFO(c.log_text());
  CHECK(joined);
  CHECK(c.monitor.rejoined("sim_node") == 0);
}
