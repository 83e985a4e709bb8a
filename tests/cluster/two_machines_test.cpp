// Tests of isolation between modalities on two machines, and with a log in place of the simulation.
#include <tactus/input_health_t.hpp>
#include <tactus/modality_report_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/pair_report_t.hpp>

#include "tests/cluster/support/two_machines.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

std::vector<std::string> without(const std::string& node) {
  std::vector<std::string> rest = kNodes;
  std::erase(rest, node);
  return rest;
}

}  // namespace

TEST_CASE("DEGRADE-1 on two machines: with audio_node stopped on the other machine the rest keep their rates", "[exclusive]") {
  TwoMachines m;
  if (!m.start()) return;
  const auto before = m.running->rates(2);
  m.running->processes.signal("audio_node", SIGTERM);
  CHECK(m.running->processes.wait_for_exit("audio_node", kPatience_s) == 0);
  std::map<std::string, std::int64_t> rendered;
  for (const std::string& sense : kSenses) rendered[sense] = m.ear().rendered(sense);
  m.running->check_rates_hold(before, 3, "audio_node");
  CHECK(m.ear().health("audio_node") == nullptr);
  CHECK(m.ear().wait_until([&] { return m.running->all_live(without("audio_node")); }, kPatience_s));
  for (const char* sense : {"haptic_node", "visual_node", "thermal_node"}) {
    INFO(sense);
    CHECK(m.ear().wait_until([&] { return m.ear().rendered(sense) > rendered.at(sense); }, kPatience_s));
  }
}

TEST_CASE(
    "DEGRADE-2 on two machines: visual_node, frozen there for 2 s, disturbs no other node and then "
    "shows the present state", "[exclusive]") {
  TwoMachines m;
  if (!m.start()) return;
  const auto before = m.running->rates(2);
  const std::int64_t frames = m.ear().ticks("visual_node"), missed = m.ear().health("visual_node")->missed_ticks;
  m.running->processes.signal("visual_node", SIGSTOP);
  m.running->check_rates_hold(before, 2, "visual_node");
  CHECK(m.ear().health("visual_node") == nullptr);
  m.running->processes.signal("visual_node", SIGCONT);
  REQUIRE(m.ear().wait_until([&] { return m.running->lives("visual_node"); }, kPatience_s));
  m.ear().listen(1);
  const node_health_t* h = m.ear().health("visual_node");
  REQUIRE(h != nullptr);
  CHECK(h->ticks > frames);
  // The node skipped the missed frames: two seconds at its rate.
  CHECK(h->missed_ticks - missed > before.at("visual_node"));
  for (const input_health_t& in : h->inputs) {
    INFO(in.channel << " is " << in.age_ns << " ns old");
    if (in.channel == channels::kWorldState || in.channel == channels::kContactEvents)
      CHECK(in.age_ns < 500'000'000);
  }
  CHECK(m.ear().wait_until([&] { return m.running->all_live(kNodes); }, kPatience_s));
}

TEST_CASE(
    "DEGRADE-3 on two machines: when sim_node dies the force fades, all nodes report it and resume with "
    "the next sim_node", "[exclusive]") {
  TwoMachines m;
  if (!m.start()) return;
  REQUIRE(m.ear().wait_until([&] { return m.ear().force_N() > 0; }, kPatience_s));
  m.running->processes.signal("sim_node", SIGKILL);
  m.running->processes.wait_for_exit("sim_node", kPatience_s);
  CHECK(m.ear().wait_until([&] { return m.ear().force_N() == 0 && m.ear().tool_state()->fade == 0; }, 5));
  for (const std::string& node : kSenses) {
    INFO(node);
    CHECK(m.ear().wait_until(
        [&] {
          return m.running->state(node, node_health_t::INPUT_LOST) || m.running->state(node, node_health_t::STALE);
        },
        kPatience_s));
  }
  m.start_node("sim_node");
  REQUIRE(m.ear().wait_until([&] { return m.ear().rejoined("sim_node") == 1 && m.running->all_live(kNodes); },
                             kPatience_s));
  CHECK(m.ear().wait_until([&] { return m.ear().force_N() > 0; }, kPatience_s));
  for (const std::string& sense : kSenses) {
    INFO(sense);
    const std::int64_t rendered = m.ear().rendered(sense);
    CHECK(m.ear().rejoined(sense) == 0);
    CHECK(m.ear().wait_until([&] { return m.ear().rendered(sense) > rendered; }, kPatience_s));
  }
}

TEST_CASE("DEGRADE-4 on two machines: every killed and restarted node rejoins by itself", "[exclusive]") {
  TwoMachines m;
  if (!m.start()) return;
  for (const std::string& node : kNodes) {
    INFO(node);
    m.running->processes.signal(node, SIGKILL);
    m.running->processes.wait_for_exit(node, kPatience_s);
    m.start_node(node);
    REQUIRE(m.ear().wait_until([&] { return m.ear().rejoined(node) == 1; }, kPatience_s));
    REQUIRE(m.ear().wait_until([&] { return m.running->all_live(kNodes); }, kPatience_s));
  }
  for (const std::string& node : kNodes) CHECK(m.ear().rejoined(node) == 1);
}

TEST_CASE("On two machines no event is lost, and all asynchronies are converted to one clock", "[exclusive]") {
  TwoMachines m;
  if (!m.start()) return;
  const auto source = static_cast<std::int32_t>(sync::fnv1a_32("sync_node"));
  std::map<std::string, modality_report_t> kept;
  std::map<std::string, pair_report_t> pairs;
  const bool enough = m.ear().wait_until(
      [&] {
        while (const auto r = m.reports->pop()) {
          if (r->message.header.source != source) continue;
          for (const modality_report_t& x : r->message.modalities) kept[x.modality] = x;
          for (const pair_report_t& x : r->message.pairs) pairs[x.a + " " + x.b] = x;
        }
        return pairs["haptic audio"].n > 10 && pairs["haptic visual"].n > 10 && pairs["haptic thermal"].n > 10;
      },
      kPatience_s);
  INFO(m.running->words());
  for (const auto& [names, p] : pairs)
    UNSCOPED_INFO(names << ": " << p.n << " asynchronies, median " << p.p50_ns << " ns");
  REQUIRE(enough);
  for (const auto& [modality, r] : kept) {
    INFO(modality << " lost " << r.lost << " of " << r.owed);
    CHECK(r.owed > 0);
    CHECK(r.lost == 0);
  }
  // The wrong clock would give an hour; a slow machine gives half a second.
  for (const char* names : {"haptic audio", "haptic visual", "haptic thermal"})
    CHECK(std::abs(pairs[names].p50_ns) < 500'000'000);
}

TEST_CASE(
    "While lcm-logplayer replays a log, one modality is stopped, another frozen and a third killed, and "
    "the rest keep rendering", "[exclusive]") {
  Folder folder;
  {
    Running c;
    c.processes.start("recorder");
    c.start();
    c.ear.listen(14);
    c.processes.signal("recorder", SIGTERM);
    REQUIRE(c.processes.wait_for_exit("recorder", kPatience_s) == 0);
    std::filesystem::rename(c.folder.path() / "run.lcmlog", folder.path() / "run.lcmlog");
  }
  constexpr std::int64_t kOtherRun = Running::kRunId + 1;
  const std::string stopped = "audio_node", frozen = "thermal_node", goes_on = "visual_node";
  Processes processes(folder.path() / "again", kOtherRun);
  Ear ear(kOtherRun);
  for (const std::string& node : {stopped, frozen, goes_on}) processes.start(node);
  REQUIRE(ear.wait_until([&] { return ear.health(stopped) && ear.health(frozen) && ear.health(goes_on); },
                         kPatience_s));
  processes.spawn("lcm-logplayer",
                  {"lcm-logplayer", "-l", "udpm://239.255.76.67:7667?ttl=0", folder.path() / "run.lcmlog"});
  REQUIRE(ear.wait_until(
      [&] { return ear.rendered(stopped) > 0 && ear.rendered(frozen) > 0 && ear.rendered(goes_on) > 0; },
      kPatience_s));

  processes.signal(stopped, SIGTERM);
  CHECK(processes.wait_for_exit(stopped, kPatience_s) == 0);
  processes.signal(frozen, SIGSTOP);
  std::int64_t rendered = ear.rendered(goes_on), ticks = ear.ticks(goes_on);
  CHECK(ear.wait_until([&] { return ear.rendered(goes_on) > rendered + 2; }, kPatience_s));
  CHECK(ear.ticks(goes_on) > ticks);
  processes.signal(frozen, SIGCONT);
  rendered = ear.rendered(frozen);
  CHECK(ear.wait_until([&] { return ear.rendered(frozen) > rendered; }, kPatience_s));
  processes.kill(frozen);
  rendered = ear.rendered(goes_on);
  CHECK(ear.wait_until([&] { return ear.rendered(goes_on) > rendered; }, kPatience_s));
  CHECK(processes.running(goes_on));
  CHECK(ear.rejoined(goes_on) == 0);
}
