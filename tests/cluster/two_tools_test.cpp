// Several hands on one scene, each a process: one goes and one comes, and neither the world nor the hand that
// stays notices.
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "sync/pacing.h"
#include "tests/cluster/run_log.h"
#include "tests/cluster/run_script.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr int kLeft = 0, kRight = 1, kThird = 2;  // order of the tools in three_hands.sdf
constexpr double kPeriod_s = 0.5;                 // of the taps of the left one

void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// What the world and the hand that stays are like over a while.
struct Figures {
  double sim_Hz = 0, hand_Hz = 0;                     // steps told to that hand, ticks of its loop
  double sim_step_p50_ms = 0, sim_step_p99_ms = 0;    // from one touch model to the next
  double hand_step_p50_ms = 0, hand_step_p99_ms = 0;  // from one tool state to the next
  double age_p50_ms = 0, age_p90_ms = 0;  // of the newest touch model, as that hand says it 10 times a second
  double felt_p50_ms = 0;                 // from a hit to its vibration
  std::vector<double> force_N;            // by ms of the path that is repeated, median
  double peak_N() const { return *std::max_element(force_N.begin(), force_N.end()); }
};

Figures of_span(const RunLog& log, const Span& span) {
  Figures f;
  std::vector<std::int64_t> steps, ticks;
  std::vector<std::vector<double>> force(static_cast<std::size_t>(kPeriod_s * 1000));
  log.each<touch_model_t>(channels::kTouchModel, span, [&](const touch_model_t& m) {
    if (m.tool == kLeft && m.page == 0) steps.push_back(m.header.publish_time_ns);
  });
  log.each<tool_state_t>(channels::kToolState, span, [&](const tool_state_t& m) {
    if (m.tool != kLeft) return;
    ticks.push_back(m.header.publish_time_ns);
    // Of the host's time, which the path of a virtual hand keeps.
    const auto ms = static_cast<std::size_t>(m.header.publish_time_ns / 1'000'000) % force.size();
    force[ms].push_back(std::hypot(m.force_N.x, m.force_N.y, m.force_N.z));
  });
  std::vector<double> ages, felt;
  log.each<node_health_t>(channels::kNodeHealth, span, [&](const node_health_t& m) {
    for (const input_health_t& in : m.inputs)
      if (m.node == "haptic_node" && in.channel == channels::kTouchModel)
        ages.push_back(static_cast<double>(in.age_ns) * 1e-6);
  });
  std::map<std::int64_t, std::int64_t> happened_ns;
  log.each<contact_events_t>(channels::kContactEvents, span, [&](const contact_events_t& m) {
    for (const contact_event_t& e : m.events)
      if (e.tool == kLeft && e.kind == contact_event_t::HIT && m.clock.rate > 0)
        happened_ns[e.event_id] =
            m.clock.host_ns +
            static_cast<std::int64_t>(static_cast<double>(e.time_ns - m.clock.sim_ns) / m.clock.rate);
  });
  log.each<presented_t>(channels::kPresented, span, [&](const presented_t& m) {
    for (const presentation_t& p : m.reports)
      if (m.modality == "haptic" && p.part == presentation_t::TRANSIENT && p.presented_ns >= 0 &&
          happened_ns.contains(p.event_id))
        felt.push_back(static_cast<double>(p.presented_ns - happened_ns.at(p.event_id)) * 1e-6);
  });
  f.sim_Hz = static_cast<double>(steps.size()) / span.seconds();
  f.hand_Hz = static_cast<double>(ticks.size()) / span.seconds();
  f.sim_step_p50_ms = quantile(steps_ms(steps), 0.5), f.sim_step_p99_ms = quantile(steps_ms(steps), 0.99);
  f.hand_step_p50_ms = quantile(steps_ms(ticks), 0.5), f.hand_step_p99_ms = quantile(steps_ms(ticks), 0.99);
  f.age_p50_ms = quantile(ages, 0.5), f.age_p90_ms = quantile(ages, 0.9);
  f.felt_p50_ms = quantile(felt, 0.5);
  for (const auto& samples : force) f.force_N.push_back(quantile(samples, 0.5));
  return f;
}

// The best of each figure over three spans: other work on the machine comes and goes, and holds now the world and
// now a hand back, but what the other hands do to them would be in all three. The force is the median.
Figures figures(const RunLog& log, const std::vector<Span>& spans) {
  std::vector<Figures> each;
  for (const Span& span : spans) each.push_back(of_span(log, span));
  const auto values = [&](const auto& get) {
    std::vector<double> x;
    for (const Figures& f : each) x.push_back(get(f));
    return x;
  };
  Figures f;
  for (const auto rate : {&Figures::sim_Hz, &Figures::hand_Hz})
    f.*rate = quantile(values([&](const Figures& g) { return g.*rate; }), 1);
  for (const auto time :
       {&Figures::sim_step_p50_ms, &Figures::sim_step_p99_ms, &Figures::hand_step_p50_ms,
        &Figures::hand_step_p99_ms, &Figures::age_p50_ms, &Figures::age_p90_ms, &Figures::felt_p50_ms})
    f.*time = quantile(values([&](const Figures& g) { return g.*time; }), 0);
  for (std::size_t ms = 0; ms < each.front().force_N.size(); ++ms)
    f.force_N.push_back(quantile(values([&](const Figures& g) { return g.force_N[ms]; }), 0.5));
  return f;
}

// Mean difference of two traces of force where either is felt, N: of the same taps some ms apart it is small, too.
double apart_N(const Figures& a, const Figures& b) {
  double sum = 0;
  int felt = 0;
  for (std::size_t i = 0; i < a.force_N.size(); ++i) {
    if (std::max(a.force_N[i], b.force_N[i]) < 0.01) continue;
    sum += std::abs(a.force_N[i] - b.force_N[i]);
    ++felt;
  }
  return felt > 0 ? sum / felt : 0;
}

std::string words(const Figures& f) {
  std::ostringstream out;
  out << "sim " << f.sim_Hz << " Hz, step " << f.sim_step_p50_ms << " / " << f.sim_step_p99_ms
      << " ms (p50 / p99); hand " << f.hand_Hz << " Hz, tick " << f.hand_step_p50_ms << " / " << f.hand_step_p99_ms
      << " ms; touch model " << f.age_p50_ms << " / " << f.age_p90_ms << " ms old (p50 / p90); felt after "
      << f.felt_p50_ms << " ms; peak " << f.peak_N() << " N\n";
  return out.str();
}

// Beside other work single ticks come late, with and without the other hands: only what is a multiple is an
// effect.
void check_unchanged(const Figures& before, const Figures& now) {
  const auto close = [](double a, double b, double share) { return std::abs(b - a) <= share * a; };
  const auto no_later = [](double a, double b, double factor, double least_ms) {
    return b <= factor * std::max(a, least_ms);
  };
  CHECK(close(before.sim_Hz, now.sim_Hz, 0.02));
  CHECK(close(before.hand_Hz, now.hand_Hz, 0.02));
  CHECK(close(before.sim_step_p50_ms, now.sim_step_p50_ms, 0.05));
  CHECK(close(before.hand_step_p50_ms, now.hand_step_p50_ms, 0.05));
  CHECK(no_later(before.sim_step_p99_ms, now.sim_step_p99_ms, 1.5, 2));
  CHECK(no_later(before.hand_step_p99_ms, now.hand_step_p99_ms, 1.5, 2));
  CHECK(no_later(before.age_p50_ms, now.age_p50_ms, 1.5, 1));
  CHECK(no_later(before.age_p90_ms, now.age_p90_ms, 1.5, 2));
  CHECK(now.felt_p50_ms > 0);
  CHECK(no_later(before.felt_p50_ms, now.felt_p50_ms, 1.5, 2));
  CHECK(close(before.peak_N(), now.peak_N(), 0.1));
  CHECK(apart_N(before, now) < 0.1 * before.peak_N());
}

// Begins of a tool without their end.
std::set<std::int64_t> left_open(const RunLog& log, int tool) {
  std::set<std::int64_t> open, ended;
  log.each<contact_events_t>(channels::kContactEvents, [&](const contact_events_t& m) {
    for (const contact_event_t& e : m.events) {
      if (e.tool != tool) continue;
      if (e.kind == contact_event_t::BEGIN) open.insert(e.contact_id);
      if (e.kind == contact_event_t::END) ended.insert(e.contact_id);
    }
  });
  std::erase_if(open, [&](std::int64_t id) { return ended.contains(id); });
  return open;
}

int begins(const RunLog& log, int tool) {
  std::set<std::int64_t> ids;
  log.each<contact_events_t>(channels::kContactEvents, [&](const contact_events_t& m) {
    for (const contact_event_t& e : m.events)
      if (e.tool == tool && e.kind == contact_event_t::BEGIN) ids.insert(e.event_id);
  });
  return static_cast<int>(ids.size());
}

double largest_N(const RunLog& log, int tool, const std::vector<Span>& spans) {
  const Span span{spans.front().from_ns, spans.back().to_ns};
  double most = 0;
  log.each<tool_state_t>(channels::kToolState, span, [&](const tool_state_t& m) {
    if (m.tool == tool) most = std::max<double>(most, std::hypot(m.force_N.x, m.force_N.y, m.force_N.z));
  });
  return most;
}

struct ThreeHands : RunScript {
  std::string service(const std::string& node) const { return out() / "cluster/services" / node; }
  void begin() {
    start({(repository() / "tests/cluster/three_hands.sdf").string(), "--seconds", "60", "--without",
           "visual_node", "--out", out()});
    const auto up = [&] {
      return contents(out() / "logs/sim_node.log").find("the world begins") != std::string::npos;
    };
    for (int i = 0; i < 1200 && !up(); ++i) sleep_s(0.05);
    INFO(processes.said("run"));
    REQUIRE(up());
  }
  // Three spans in which nothing is changed, once what was changed has settled.
  std::vector<Span> watch() {
    sleep_s(0.5);
    std::vector<Span> spans;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t from = sync::to_ns(sync::host_now());
      sleep_s(1.5);
      spans.push_back({from, sync::to_ns(sync::host_now())});
    }
    return spans;
  }
};

}  // namespace

TEST_CASE("Of several hands one goes and another comes, and neither the world nor the hand that stays notices") {
  ThreeHands c;
  c.begin();
  c.output_of({"sv", "down", c.service("haptic_node_third")});
  sleep_s(1.5);
  const auto two = c.watch();
  c.output_of({"sv", "down", c.service("haptic_node_right")});
  const auto alone = c.watch();
  c.output_of({"sv", "up", c.service("haptic_node_third")});
  const auto joined = c.watch();
  c.output_of({"sv", "kill", c.service("haptic_node_third")});  // comes back by itself
  const auto again = c.watch();
  c.processes.signal("run", SIGINT);
  c.finish(60);

  const RunLog log(c.out());
  const Figures before = figures(log, two);
  const std::vector<std::pair<const char*, std::vector<Span>>> after{
      {"alone", alone}, {"joined", joined}, {"again", again}};
  std::string table = "two hands: " + words(before);
  for (const auto& [name, spans] : after) table += std::string(name) + ": " + words(figures(log, spans));
  if (std::getenv("TACTUS_PRINT")) std::cout << table;
  INFO(table);
  REQUIRE(before.sim_Hz > 900);
  REQUIRE(before.peak_N() > 0.5);
  for (const auto& [name, spans] : after) {
    INFO(name);
    check_unchanged(before, figures(log, spans));
    // Nor in the half second in which it goes or comes.
    const Figures meanwhile = of_span(log, {spans.front().from_ns - 500'000'000, spans.front().from_ns});
    CHECK(meanwhile.sim_step_p50_ms == Approx(1).margin(0.05));
    CHECK(meanwhile.hand_step_p50_ms == Approx(1).margin(0.05));
  }

  // The right one pressed when it went.
  CHECK(largest_N(log, kRight, two) > 0.5);
  CHECK(begins(log, kRight) >= 1);
  CHECK(left_open(log, kRight).empty());
  CHECK(largest_N(log, kRight, joined) == 0);
  // The third one works, both times.
  CHECK(largest_N(log, kThird, alone) == 0);
  CHECK(largest_N(log, kThird, joined) > 0.5);
  CHECK(largest_N(log, kThird, again) > 0.5);
  CHECK(begins(log, kThird) >= 2);

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
