// Tests of several hands on one scene, each a process: hands leave and join, and neither the simulation nor the remaining hand is
// affected.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/clocks/pacing.h"
#include "sync/node/realtime.h"
#include "tests/cluster/support/hand_figures.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// A span in which an empty loop of 1000 Hz runs in a thread with real-time priority, below that of the nodes. A machine that
// stands still for a moment delays it as it delays the nodes.
Span span_with_empty_loop(double seconds) {
  std::vector<std::int64_t> ticks;
  Span span{sync::to_ns(sync::host_now()), 0};
  std::jthread([&] {
    sync::set_fifo(30);
    sync::Loop loop(1000);
    const sync::HostTime end = sync::host_now() + sync::from_seconds(seconds);
    for (sync::HostTime now; (now = loop.wait()) < end;) ticks.push_back(sync::to_ns(now));
  }).join();
  span.to_ns = sync::to_ns(sync::host_now());
  span.machine_Hz = static_cast<double>(ticks.size()) / span.seconds();
  span.machine_p99_ms = quantile(steps_ms(ticks), 0.99);
  return span;
}

void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Beside other work single ticks come late, with and without the other hands. Only a multiple of the figures before is an effect.
void check_unchanged(const Figures& before, const Figures& now) {
  const auto within = [](double a, double b, double share) { return std::abs(b - a) <= share * a; };
  const auto no_later = [](double a, double b, double factor, double least_ms) {
    return b <= factor * std::max(a, least_ms);
  };
  CHECK(within(before.sim_Hz, now.sim_Hz, 0.02));
  CHECK(within(before.hand_Hz, now.hand_Hz, 0.02));
  CHECK(within(before.sim_step_p50_ms, now.sim_step_p50_ms, 0.05));
  CHECK(within(before.hand_step_p50_ms, now.hand_step_p50_ms, 0.05));
  const double machine_ms = std::max(2.0, now.machine_p99_ms);
  CHECK(no_later(before.sim_step_p99_ms, now.sim_step_p99_ms, 1.5, machine_ms));
  CHECK(no_later(before.hand_step_p99_ms, now.hand_step_p99_ms, 1.5, machine_ms));
  CHECK(no_later(before.age_p50_ms, now.age_p50_ms, 1.5, 1));
  CHECK(no_later(before.age_p90_ms, now.age_p90_ms, 1.5, 2));
  CHECK(now.felt_p50_ms > 0);
  CHECK(no_later(before.felt_p50_ms, now.felt_p50_ms, 1.5, 2));
  CHECK(within(before.peak_N(), now.peak_N(), 0.1));
  CHECK(mean_difference_N(before, now) < 0.05 * before.peak_N());
}

// Begins of a tool's contacts without an end.
std::set<std::int64_t> open_contacts(const RunLog& log, int tool) {
  std::set<std::int64_t> open, ended;
  log.for_each<contact_events_t>(channels::kContactEvents, [&](const contact_events_t& m) {
    for (const contact_event_t& e : m.events) {
      if (e.tool != tool) continue;
      if (e.kind == contact_event_t::BEGIN) open.insert(e.contact_id);
      if (e.kind == contact_event_t::END) ended.insert(e.contact_id);
    }
  });
  std::erase_if(open, [&](std::int64_t id) { return ended.contains(id); });
  return open;
}

int begin_count(const RunLog& log, int tool) {
  std::set<std::int64_t> ids;
  log.for_each<contact_events_t>(channels::kContactEvents, [&](const contact_events_t& m) {
    for (const contact_event_t& e : m.events)
      if (e.tool == tool && e.kind == contact_event_t::BEGIN) ids.insert(e.event_id);
  });
  return static_cast<int>(ids.size());
}

double max_force_N(const RunLog& log, int tool, const std::vector<Span>& spans) {
  const Span span{spans.front().from_ns, spans.back().to_ns};
  double max = 0;
  log.for_each<tool_state_t>(channels::kToolState, span, [&](const tool_state_t& m) {
    if (m.tool == tool) max = std::max<double>(max, std::hypot(m.force_N.x, m.force_N.y, m.force_N.z));
  });
  return max;
}

struct ThreeHands : RunScript {
  std::string service(const std::string& node) const { return out() / "cluster/services" / node; }
  void begin() {
    start({(repository() / "tests/cluster/scenes/three_hands.sdf").string(), "--seconds", "60", "--without",
           "visual_node", "--out", out()});
    const auto up = [&] {
      return contents(out() / "logs/sim_node.log").find("the world begins") != std::string::npos;
    };
    for (int i = 0; i < 1200 && !up(); ++i) sleep_s(0.05);
    INFO(processes.output("run"));
    REQUIRE(up());
  }
  // Three spans without changes, after the last change has settled.
  std::vector<Span> record_spans() {
    sleep_s(0.5);
    std::vector<Span> spans;
    for (int i = 0; i < 3; ++i) spans.push_back(span_with_empty_loop(1.5));
    return spans;
  }
};

// One hand leaves; another joins, is killed and comes back; one is set to push less.
struct Scenario {
  ThreeHands c;
  std::vector<Span> two, alone, joined, again, gentle;

  Scenario() {
    c.begin();
    c.output_of({"sv", "down", c.service("haptic_node_third")});
    sleep_s(1.5);
    two = c.record_spans();
    c.output_of({"sv", "down", c.service("haptic_node_right")});
    alone = c.record_spans();
    c.output_of({"sv", "up", c.service("haptic_node_third")});
    joined = c.record_spans();
    c.output_of({"sv", "kill", c.service("haptic_node_third")});  // the supervisor restarts it
    again = c.record_spans();
    // Through the command line script.
    const std::string answer =
        c.output_of({"env", "TACTUS_BIN=" + programs().string(), repository() / "scripts/tactus", "set", "--in", c.out(),
                     "haptic_node", "force_limit=1N"});
    CHECK_THAT(answer, Catch::Contains("force_limit is 1N"));
    gentle = c.record_spans();
    c.processes.signal("run", SIGINT);
    CHECK(c.finish(60) == 0);  // a hand that was removed does not count as missing
    CHECK_THAT(c.processes.output("run"), Catch::Contains("haptic_node_right was taken down"));
  }
};

}  // namespace

TEST_CASE("One of several hands leaves and another joins without an effect on the simulation and the remaining hand", "[exact]") {
  // Repeats the run once when the machine was too slow even before the first change: there is no baseline then.
  auto scenario = std::make_unique<Scenario>();
  for (int tries = 1; tries < 3 && figures(RunLog(scenario->c.out()), scenario->two).sim_Hz < 990; ++tries) {
    scenario.reset();
    scenario = std::make_unique<Scenario>();
  }
  const ThreeHands& c = scenario->c;
  const auto &two = scenario->two, &alone = scenario->alone, &joined = scenario->joined, &again = scenario->again,
             &gentle = scenario->gentle;

  const RunLog log(c.out());
  const Figures before = figures(log, two);
  const std::vector<std::pair<const char*, std::vector<Span>>> after{
      {"alone", alone}, {"joined", joined}, {"again", again}};
  std::string table = "two hands: " + to_text(before);
  for (const auto& [name, spans] : after) table += std::string(name) + ": " + to_text(figures(log, spans));
  if (std::getenv("TACTUS_PRINT")) std::cout << table;
  INFO(table);
  REQUIRE(before.sim_Hz > 900);
  REQUIRE(before.peak_N() > 0.5);
  for (const auto& [name, spans] : after) {
    INFO(name);
    check_unchanged(before, figures(log, spans));
    // Also during the half second in which a hand leaves or joins.
    const Figures meanwhile = figures_of_span(log, {spans.front().from_ns - 500'000'000, spans.front().from_ns});
    CHECK(meanwhile.sim_step_p50_ms == Approx(1).margin(0.05));
    CHECK(meanwhile.hand_step_p50_ms == Approx(1).margin(0.05));
  }

  // The right hand pressed when it left.
  CHECK(max_force_N(log, kRight, two) > 0.5);
  CHECK(begin_count(log, kRight) >= 1);
  CHECK(open_contacts(log, kRight).empty());
  CHECK(max_force_N(log, kRight, joined) == 0);
  // The third hand works, both times.
  CHECK(max_force_N(log, kThird, alone) == 0);
  CHECK(max_force_N(log, kThird, joined) > 0.5);
  CHECK(max_force_N(log, kThird, again) > 0.5);
  CHECK(begin_count(log, kThird) >= 2);
  CHECK(max_force_N(log, kLeft, again) > 1.5);
  CHECK(max_force_N(log, kLeft, gentle) <= 1 + 1e-6);
  CHECK(max_force_N(log, kLeft, gentle) > 0.9);
  CHECK(max_force_N(log, kThird, gentle) == Approx(max_force_N(log, kThird, again)).epsilon(0.3));

  const auto summary = nlohmann::json::parse(contents(c.out() / "summary.json"), nullptr, false);
  REQUIRE_FALSE(summary.is_discarded());
  for (const auto& [channel, counts] : summary["bus"].items()) {
    INFO(channel);
    CHECK(counts["gaps"] == 0);
  }
  for (const auto& [sense, counts] : summary["contacts"]["by_modality"].items()) {
    INFO(sense << ": " << counts.dump());
    CHECK(counts["lost"] == 0);
  }
}
