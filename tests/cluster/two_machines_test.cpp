// Tests of isolation between modalities on two machines, and with a log in place of the simulation.
#include <tactus/input_health_t.hpp>
#include <tactus/modality_report_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/pair_report_t.hpp>

#include "tests/cluster/support/two_machines.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

std::vector<std::string> others_than(const std::string& node) {
  std::vector<std::string> rest = kNodes;
  std::erase(rest, node);
  return rest;
}

}  // namespace

TEST_CASE("DEGRADE-1 on two machines: with audio_node stopped on the other machine the rest keep their rates") {
  TwoMachines m;
  if (!m.start()) return;
  const auto before = m.running->rates(2);
  m.running->processes.signal("audio_node", SIGTERM);
  CHECK(m.running->processes.wait_for_exit("audio_node", kTimeout_s) == 0);
  std::map<std::string, std::int64_t> rendered;
  for (const std::string& sense : kModalityNodes) rendered[sense] = m.monitor().rendered(sense);
  m.running->check_rates_hold(before, 3, "audio_node");
  CHECK(m.monitor().wait_until([&] { return m.monitor().health("audio_node") == nullptr; }, kTimeout_s));
  CHECK(m.monitor().wait_until([&] { return m.running->all_running(others_than("audio_node")); }, kTimeout_s));
  for (const char* sense : {"haptic_node", "visual_node", "thermal_node"}) {
    INFO(sense);
    CHECK(m.monitor().wait_until([&] { return m.monitor().rendered(sense) > rendered.at(sense); }, kTimeout_s));
  }
}

TEST_CASE(
    "DEGRADE-2 on two machines: visual_node, frozen there for 2 s, disturbs no other node and then "
    "shows the present state") {
  TwoMachines m;
  if (!m.start()) return;
  const auto before = m.running->rates(2);
  const std::int64_t frames = m.monitor().ticks("visual_node"), missed = m.monitor().newest_health("visual_node").missed_ticks;
  m.running->processes.signal("visual_node", SIGSTOP);
  m.running->check_rates_hold(before, 2, "visual_node");
  CHECK(m.monitor().wait_until([&] { return m.monitor().health("visual_node") == nullptr; }, kTimeout_s));
  m.running->processes.signal("visual_node", SIGCONT);
  REQUIRE(m.monitor().wait_until([&] { return m.running->is_running("visual_node"); }, kTimeout_s));
  m.monitor().receive_for(1);
  const node_health_t* h = m.monitor().health("visual_node");
  REQUIRE(h != nullptr);
  CHECK(h->ticks > frames);
  // The node skipped the missed frames: two seconds at its rate.
  CHECK(h->missed_ticks - missed > before.at("visual_node"));
  CHECK(m.monitor().wait_until([&] { return m.running->receives_the_present("visual_node"); }, kTimeout_s));
  CHECK(m.monitor().wait_until([&] { return m.running->all_running(kNodes); }, kTimeout_s));
}

TEST_CASE(
    "DEGRADE-3 on two machines: when sim_node dies the force fades, all nodes report it and resume with "
    "the next sim_node") {
  TwoMachines m;
  if (!m.start()) return;
  REQUIRE(m.monitor().wait_until([&] { return m.monitor().force_N() > 0; }, kTimeout_s));
  m.running->processes.signal("sim_node", SIGKILL);
  m.running->processes.wait_for_exit("sim_node", kTimeout_s);
  CHECK(m.monitor().wait_until([&] { return m.monitor().force_N() == 0 && m.monitor().tool_state()->fade == 0; }, 5));
  for (const std::string& node : kModalityNodes) {
    INFO(node);
    CHECK(m.monitor().wait_until(
        [&] {
          return m.running->state(node, node_health_t::INPUT_LOST) || m.running->state(node, node_health_t::STALE);
        },
        kTimeout_s));
  }
  m.start_node("sim_node");
  REQUIRE(m.monitor().wait_until([&] { return m.monitor().rejoined("sim_node") == 1 && m.running->all_running(kNodes); },
                             kTimeout_s));
  CHECK(m.monitor().wait_until([&] { return m.monitor().force_N() > 0; }, kTimeout_s));
  for (const std::string& sense : kModalityNodes) {
    INFO(sense);
    const std::int64_t rendered = m.monitor().rendered(sense);
    CHECK(m.monitor().rejoined(sense) == 0);
    CHECK(m.monitor().wait_until([&] { return m.monitor().rendered(sense) > rendered; }, kTimeout_s));
  }
}

TEST_CASE("DEGRADE-4 on two machines: every killed and restarted node rejoins by itself") {
  TwoMachines m;
  if (!m.start()) return;
  for (const std::string& node : kNodes) {
    INFO(node);
    m.running->processes.signal(node, SIGKILL);
    m.running->processes.wait_for_exit(node, kTimeout_s);
    m.start_node(node);
    REQUIRE(m.monitor().wait_until([&] { return m.monitor().rejoined(node) == 1; }, kTimeout_s));
    REQUIRE(m.monitor().wait_until([&] { return m.running->all_running(kNodes); }, kTimeout_s));
  }
  for (const std::string& node : kNodes) CHECK(m.monitor().rejoined(node) == 1);
}

TEST_CASE("On two machines no event is lost, and all asynchronies are converted to one clock") {
  TwoMachines m;
  if (!m.start()) return;
  const auto source = static_cast<std::int32_t>(sync::fnv1a_32("sync_node"));
  std::map<std::string, modality_report_t> kept;
  std::map<std::string, pair_report_t> pairs;
  const bool enough = m.monitor().wait_until(
      [&] {
        while (const auto r = m.reports->pop()) {
          if (r->message.header.source != source) continue;
          for (const modality_report_t& x : r->message.modalities) kept[x.modality] = x;
          for (const pair_report_t& x : r->message.pairs) pairs[x.a + " " + x.b] = x;
        }
        return pairs["haptic audio"].n > 10 && pairs["haptic visual"].n > 10 && pairs["haptic thermal"].n > 10;
      },
      kTimeout_s);
  INFO(m.running->log_text());
  for (const auto& [names, p] : pairs)
    UNSCOPED_INFO(names << ": " << p.n << " asynchronies, median " << p.p50_ns << " ns");
  REQUIRE(enough);
  for (const auto& [modality, r] : kept) {
    INFO(modality << " lost " << r.lost << " of " << r.expected);
    CHECK(r.expected > 0);
    CHECK(r.lost == 0);
  }
  // The wrong clock would give an hour; a slow machine gives half a second.
  for (const char* names : {"haptic audio", "haptic visual", "haptic thermal"})
    CHECK(std::abs(pairs[names].p50_ns) < 500'000'000);
}

TEST_CASE(
    "While lcm-logplayer replays a log, one modality is stopped, another frozen and a third killed, and "
    "the rest keep rendering") {
  Folder folder;
  {
    RunningCluster c;
    c.processes.start("recorder");
    c.start();
    c.monitor.receive_for(14);
    c.processes.signal("recorder", SIGTERM);
    REQUIRE(c.processes.wait_for_exit("recorder", kTimeout_s) == 0);
    std::filesystem::rename(c.folder.path() / "run.lcmlog", folder.path() / "run.lcmlog");
  }
  constexpr std::int64_t kOtherRun = RunningCluster::kRunId + 1;
  const std::string stopped = "audio_node", frozen = "thermal_node", remaining = "visual_node";
  Processes processes(folder.path() / "again", kOtherRun);
  ClusterMonitor monitor(kOtherRun);
  for (const std::string& node : {stopped, frozen, remaining}) processes.start(node);
  REQUIRE(monitor.wait_until([&] { return monitor.health(stopped) && monitor.health(frozen) && monitor.health(remaining); },
                         kTimeout_s));
  processes.spawn("lcm-logplayer",
                  {"lcm-logplayer", "-l", "udpm://239.255.76.67:7667?ttl=0", folder.path() / "run.lcmlog"});
  REQUIRE(monitor.wait_until(
      [&] { return monitor.rendered(stopped) > 0 && monitor.rendered(frozen) > 0 && monitor.rendered(remaining) > 0; },
      kTimeout_s));

  processes.signal(stopped, SIGTERM);
  CHECK(processes.wait_for_exit(stopped, kTimeout_s) == 0);
  processes.signal(frozen, SIGSTOP);
  std::int64_t rendered = monitor.rendered(remaining), ticks = monitor.ticks(remaining);
  CHECK(monitor.wait_until([&] { return monitor.rendered(remaining) > rendered + 2; }, kTimeout_s));
  CHECK(monitor.ticks(remaining) > ticks);
  processes.signal(frozen, SIGCONT);
  rendered = monitor.rendered(frozen);
  CHECK(monitor.wait_until([&] { return monitor.rendered(frozen) > rendered; }, kTimeout_s));
  processes.kill(frozen);
  rendered = monitor.rendered(remaining);
  CHECK(monitor.wait_until([&] { return monitor.rendered(remaining) > rendered; }, kTimeout_s));
  CHECK(processes.running(remaining));
  CHECK(monitor.rejoined(remaining) == 0);
}
