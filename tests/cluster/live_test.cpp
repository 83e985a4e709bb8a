// Tests of the live page in a real browser: scripts/live/page/test performs the user's actions, and the test checks their effect on the
// bus in the log of the run.
#include <nlohmann/json.hpp>
#include <tactus/body_state_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/vec3_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/degradation/profile.h"
#include "sync/bus/identity.h"
#include "tests/cluster/support/rate_factor.h"
#include "tests/cluster/support/run_log.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus;
using namespace tactus::cluster;
using nlohmann::json;

namespace {

constexpr double kPageTimeout_s = 60;  // liveness, not speed

// The address printed by a program; "": none.
std::string address_of(Processes& processes, const std::string& name) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPageTimeout_s);
  while (std::chrono::steady_clock::now() < end && processes.running(name)) {
    const std::string output = processes.output(name);
    const std::size_t from = output.find("http://127.0.0.1:");
    if (from != std::string::npos && output.find('\n', from) != std::string::npos)
      return output.substr(from, output.find_first_of(" \n", from) - from);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return "";
}

void require_browser() {
  INFO("install the packages chromium, nodejs and npm, and run scripts/live/bundle --for-tests");
  REQUIRE(std::filesystem::exists("/usr/bin/chromium"));
  REQUIRE(std::filesystem::exists(repository() / "scripts/live/page/node_modules/puppeteer-core/package.json"));
  REQUIRE(std::filesystem::exists(repository() / "scripts/live/page/dist/main.js"));
}

// Runs a test of scripts/live/page/test to its end.
void run_browser_test(RunScript& run, const std::string& test, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"node", (repository() / "scripts/live/page/test" / test).string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  run.processes.spawn(test, command);
  const int status = run.processes.wait_for_exit(test, 9 * kPageTimeout_s);
  INFO(run.processes.output(test));
  INFO(run.processes.output("run"));
  INFO(contents(run.out() / "logs/live_server.log"));
  REQUIRE(status == 0);
}

// Times of the browser's actions, CLOCK_MONOTONIC.
struct Marks {
  json times;
  std::int64_t at(const std::string& name) const { return times.at(name).get<std::int64_t>(); }
  Span between(const std::string& from, const std::string& to) const { return {at(from), at(to)}; }
};

constexpr std::int64_t kMs = 1'000'000;

void check_commands(const RunLog& log) {
  std::map<int, std::int64_t> requested;  // id by kind
  int steps = 0;
  log.for_each<sim_command_t>(channels::kSimCommand, [&](const sim_command_t& m) {
    requested[m.kind] = m.id;
    if (m.kind == sim_command_t::STEP) steps = m.steps;
  });
  std::set<std::int64_t> done;
  log.for_each<sim_reply_t>(channels::kSimReply, [&](const sim_reply_t& m) {
    INFO(m.text);
    CHECK(m.done == 1);
    done.insert(m.id);
  });
  for (const int kind : {sim_command_t::PAUSE, sim_command_t::STEP, sim_command_t::RESUME, sim_command_t::RESET}) {
    INFO("command " << kind);
    REQUIRE(requested.contains(kind));
    CHECK(done.contains(requested[kind]));
  }
  CHECK(steps == 25);
}

// Instants of the world that are published within a span.
std::set<std::int64_t> sim_times(const RunLog& log, const Span& span) {
  std::set<std::int64_t> out;
  log.for_each<world_state_t>(channels::kWorldState, span,
                          [&](const world_state_t& m) { out.insert(m.header.sim_time_ns); });
  return out;
}

void check_world(const RunLog& log, const Marks& marks) {
  const std::int64_t paused = marks.at("paused"), stepped = marks.at("stepped");
  const auto before = sim_times(log, {paused - 200 * kMs, paused}),
             after = sim_times(log, {stepped - 400 * kMs, stepped});
  REQUIRE(before.size() == 1);
  REQUIRE(after.size() == 1);
  CHECK(*after.begin() - *before.begin() == 25 * kMs);  // 25 steps of 1 ms
  CHECK(sim_times(log, {stepped + 200 * kMs, marks.at("reset")}).size() > 5);
  // The balls, which have rested on the floor, are dropped again from at least 0.3 m.
  double before_m = 0, after_m = 0;
  log.for_each<world_state_t>(channels::kWorldState, [&](const world_state_t& m) {
    const std::int64_t t = m.header.publish_time_ns;
    for (const body_state_t& b : m.bodies) {
      if (t > stepped && t < marks.at("reset")) before_m = std::max(before_m, b.position_m.z);
      if (t > marks.at("reset") && t < marks.at("was_reset")) after_m = std::max(after_m, b.position_m.z);
    }
  });
  CHECK(before_m < 0.1);
  CHECK(after_m > 0.25);
}

void check_profile_received(const RunLog& log, std::int64_t hash, const Span& span) {
  std::set<std::string> received;
  log.for_each<node_health_t>(channels::kNodeHealth, span, [&](const node_health_t& m) {
    if (m.profile == hash) received.insert(m.modality);
  });
  for (const char* sense : {"haptic", "audio", "visual", "thermal"}) {
    INFO(sense);
    CHECK(received.contains(sense));
  }
}

void check_profiles(const RunLog& log, const Marks& marks) {
  const auto newest_in = [&](const Span& span) {
    degradation_t newest{};
    log.for_each<degradation_t>(channels::kDegradation, span, [&](const degradation_t& m) {
      if (m.generation >= newest.generation) newest = m;
    });
    return newest;
  };
  const degradation_t degraded = newest_in(marks.between("filled", "clear"));
  INFO(degraded.text);
  REQUIRE(degraded.pages == 1);  // shorter than a datagram
  std::map<std::string, sync::Rule> rules;
  for (const sync::Rule& r : sync::parse_profile(degraded.text, "of the sliders").rules) rules[r.modality] = r;
  CHECK(rules.size() == 4);
  // Rules in force before remain, including those without a slider.
  REQUIRE(rules["thermal"].delay);
  CHECK(rules["thermal"].delay->delay_s == Approx(0.03));
  CHECK(rules["thermal"].jitter);
  REQUIRE(rules["audio"].delay);
  CHECK(rules["audio"].delay->delay_s == Approx(0.08));
  REQUIRE(rules["visual"].rate);
  CHECK(rules["visual"].rate->rate_Hz == Approx(10));
  REQUIRE(rules["haptic"].loss);
  CHECK(rules["haptic"].loss->share == Approx(0.5));
  check_profile_received(log, degraded.hash, marks.between("degrade", "clear"));

  const degradation_t well = newest_in(marks.between("clear", "freeze"));
  CHECK(sync::parse_profile(well.text, "of all well").rules.empty());
  check_profile_received(log, well.hash, marks.between("clear", "freeze"));
}

void check_hand(const RunLog& log, const Marks& marks) {
  struct TimedPosition {
    std::int64_t t_ns;
    vec3_t p;
  };
  std::vector<TimedPosition> path;
  double lowest_m = 10, highest_m = -10;
  log.for_each<device_state_t>(channels::kDeviceState, [&](const device_state_t& m) {
    CHECK(m.device == "live");
    const auto& v = m.velocity_m_s;
    CHECK(std::hypot(v.x, v.y, v.z) <= 1.0001);
    path.push_back({m.header.publish_time_ns, m.pose.position_m});
    lowest_m = std::min(lowest_m, m.pose.position_m.z);
    highest_m = std::max(highest_m, m.pose.position_m.z);
  });
  REQUIRE(path.size() > 100);
  CHECK(highest_m - lowest_m > 0.05);
  // 1 m/s, and the lateness of two ticks of the server's loop on a busy machine.
  for (std::size_t i = 0, j = 0; j < path.size(); ++j) {
    while (path[j].t_ns - path[i].t_ns > 100 * kMs) ++i;
    const auto &a = path[i].p, &b = path[j].p;
    const double far_m = std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
    CHECK(far_m <= static_cast<double>(path[j].t_ns - path[i].t_ns) * 1e-9 + 0.05);
  }
  CHECK(path.front().t_ns >= marks.at("hand"));
  // The server releases the hand after 350 ms without messages.
  CHECK(path.back().t_ns < marks.at("let_go") + 1000 * kMs);

  double max_force_N = 0;
  log.for_each<tool_state_t>(channels::kToolState, marks.between("hand", "let_go"), [&](const tool_state_t& m) {
    max_force_N = std::max(max_force_N, std::hypot<double>(m.force_N.x, m.force_N.y, m.force_N.z));
  });
  CHECK(max_force_N > 0.5);  // the floor pushes back through the mouse
  std::map<int, int> states;
  log.for_each<node_health_t>(channels::kNodeHealth, marks.between("freeze", "over"), [&](const node_health_t& m) {
    if (m.node == "haptic_node") ++states[m.state];
  });
  CHECK(states[node_health_t::OUTPUT_LOST] > 0);
}

void check_tag(const RunLog& log, const Marks& marks) {
  int requested = 0, before = 0;
  log.for_each<tag_request_t>(channels::kTagRequest, [&](const tag_request_t& m) {
    if (m.header.source != static_cast<std::int32_t>(sync::fnv1a_32("live_server"))) return;
    const bool named =
        std::find(m.patterns.begin(), m.patterns.end(), "sim_node.work.collision") != m.patterns.end();
    requested += named;
    before += named && m.header.publish_time_ns < marks.at("filled");
  });
  CHECK(requested > 3);
  CHECK(before == 0);
}

// Ticks per second of each node, from NODE_HEALTH.
std::map<std::string, double> rates(const RunLog& log, const Span& span) {
  std::map<std::string, std::pair<node_health_t, node_health_t>> ends;
  log.for_each<node_health_t>(channels::kNodeHealth, span, [&](const node_health_t& m) {
    if (!ends.contains(m.node)) ends[m.node].first = m;
    ends[m.node].second = m;
  });
  std::map<std::string, double> out;
  for (const auto& [node, e] : ends) {
    const double s = static_cast<double>(e.second.header.publish_time_ns - e.first.header.publish_time_ns) * 1e-9;
    if (s > 0) out[node] = static_cast<double>(e.second.ticks - e.first.ticks) / s;
  }
  return out;
}

void check_rates_unchanged(const RunLog& log, const Marks& marks) {
  const auto before = rates(log, marks.between("filled", "degrade"));
  for (const auto& [from, to] : {std::pair{"freeze", "frozen"}, std::pair{"killed", "over"}}) {
    auto during = rates(log, marks.between(from, to));
    for (const char* node :
         {"sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "sync_node"}) {
      INFO(node << " while the browser is " << to);
      REQUIRE(before.contains(node));
      CHECK(during[node] > before.at(node) / rate_factor(node));
      CHECK(during[node] < before.at(node) * rate_factor(node));
    }
  }
}

// The last published instant of the world before a place in a log; -1: none.
std::int64_t sim_time_at(const std::filesystem::path& path, double at_s) {
  sync::MappedLog file(path);
  sync::LogScanner scanner(file.bytes());
  std::optional<std::int64_t> first_us;
  std::int64_t sim_ns = -1;
  for (sync::LogEvent e; scanner.next(e);) {
    if (!first_us) first_us = e.timestamp_us;
    if (static_cast<double>(e.timestamp_us - *first_us) * 1e-6 > at_s) break;
    if (e.channel == channels::kWorldState)
      if (const auto m = sync::decode<world_state_t>(e.data.data(), e.data.size())) sim_ns = m->clock.sim_ns;
  }
  return sim_ns;
}

}  // namespace

TEST_CASE(
    "Actions in the live page reach the bus, a frozen or killed browser changes nothing, and the log "
    "can be replayed in the page",
    "[browser]") {
  require_browser();
  RunScript run;
  const std::filesystem::path profile = run.folder.path() / "late_warmth.xml";
  std::ofstream(profile)
      << R"(<profile name="late warmth"><degrade modality="thermal" delay="30ms" jitter="5ms normal"/></profile>)";
  // Small pictures leave the processors to the browser.
  run.start({tapping_scene(), "--live", "--degrade", profile, "--device", "external:live", "--set",
             "visual_node.width=320", "--set", "visual_node.height=240", "--set", "visual_node.rate=20", "--seconds", "900",
             "--out", run.out()});
  const std::string address = address_of(run.processes, "run");
  INFO(run.processes.output("run"));
  REQUIRE_FALSE(address.empty());
  const std::filesystem::path marks_file = run.folder.path() / "marks.json",
                              seen_file = run.folder.path() / "seen.json";
  run_browser_test(run, "run.test.mjs", {address, marks_file});
  run.processes.signal("run", SIGINT);
  CHECK(run.finish(kPageTimeout_s) >= 0);

  const Marks marks{json::parse(contents(marks_file))};
  const RunLog log(run.out());
  check_hand(log, marks);
  check_tag(log, marks);
  check_profiles(log, marks);
  check_commands(log);
  check_world(log, marks);
  check_rates_unchanged(log, marks);

  const std::filesystem::path recorded = run.out() / "run.lcmlog";
  run.processes.spawn("open", {"env", "TACTUS_BIN=" + programs().string(),
                               (repository() / "scripts/tactus").string(), "live", "open", recorded});
  const std::string shown_at = address_of(run.processes, "open");
  INFO(run.processes.output("open"));
  REQUIRE_FALSE(shown_at.empty());
  run_browser_test(run, "log.test.mjs", {shown_at, seen_file});
  const json seen = json::parse(contents(seen_file));
  REQUIRE(seen["places"].size() == 3);
  for (const json& place : seen["places"]) {
    const double to_s = place["to_s"].get<double>();
    INFO(place.dump());
    // Shown to four figures. The world is published 100 times per second, and a variable is decimated to 200 points.
    const auto expected = static_cast<double>(sim_time_at(recorded, to_s));
    CHECK(place["sim_ns"].get<double>() == Approx(expected).margin(60e6));
  }
  run.processes.signal("open", SIGTERM);
  CHECK(run.processes.wait_for_exit("open", kPageTimeout_s) >= 0);
}
