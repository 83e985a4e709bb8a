// compare_aligners: applies every aligner to the same trace of latencies, and prints a table.
//
//   in   LOG...   logs of runs: the latency that each modality needed for each event, from PRESENTED; none: a synthetic trace
//
// The synthetic trace: three modalities at 20, 33 and 12 ms with tails (exponential, 4 ms; Pareto of shape 2.5, 3 ms; none),
// and 15 ms more for the second one from a third of the trace on, as when a network is loaded.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presented_t.hpp>

#include "sync/bus/decode.h"
#include "sync/log/log_reader.h"
#include "sync/log/mapped_log.h"
#include "sync/node/node.h"
#include "sync/playout/comparison.h"
#include "sync/playout/policy.h"
#include "sync/presentation/presentation_matcher.h"

using namespace tactus;

namespace {

constexpr int kMadeEvents = 6000;
constexpr int kRepeats = 20;  // for the cost

sync::Nanoseconds ms(double value) { return sync::from_seconds(value * 1e-3); }
double to_ms(sync::Nanoseconds t) { return sync::to_seconds(t) * 1e3; }

std::vector<sync::TraceEvent> made_trace(unsigned seed) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> exponential(1 / 4.0);
  std::uniform_real_distribution<double> uniform(1e-6, 1);
  std::vector<sync::TraceEvent> trace;
  for (int i = 0; i < kMadeEvents; ++i) {
    const double loaded = i > kMadeEvents / 3 && i < 2 * kMadeEvents / 3 ? 15 : 0;
    const double pareto = 3 * (std::pow(uniform(random), -1 / 2.5) - 1);
    trace.push_back(
        {{"audio", ms(20 + exponential(random))}, {"visual", ms(33 + loaded + pareto)}, {"haptic", ms(12)}});
  }
  return trace;
}

// In order of the events' first presentation.
std::vector<sync::TraceEvent> logged_trace(const std::vector<std::string>& logs) {
  auto maps = std::make_unique<sync::ClockMaps>(0);
  sync::PresentationMatcher matcher(sync::OwnClock(0, 0, maps.get()));
  std::vector<std::int64_t> order;
  std::map<std::int64_t, sync::TraceEvent> events;
  for (const std::string& path : logs) {
    const sync::MappedLog file(path);
    sync::LogScanner scanner(file.bytes());
    for (sync::LogEvent e; scanner.next(e);) {
      const auto observe = [&]<class Message>(const char* channel, Message*) {
        if (e.channel != channel) return;
        const auto m = sync::decode<Message>(e.data.data(), e.data.size());
        if (!m) return;
        const auto sent = sync::host_time(m->header.publish_time_ns);
        matcher.observe(*m, sent);
        matcher.advance(sent);
      };
      observe(channels::kNodeHealth, static_cast<node_health_t*>(nullptr));
      observe(channels::kContactEvents, static_cast<contact_events_t*>(nullptr));
      observe(channels::kPresented, static_cast<presented_t*>(nullptr));
      for (const auto& need : matcher.take_needs()) {
        const auto [it, first] = events.try_emplace(need.event_id);
        if (first) order.push_back(need.event_id);
        it->second[need.modality] = need.needed;
      }
    }
  }
  std::vector<sync::TraceEvent> trace;
  for (const std::int64_t id : order)
    if (events[id].size() > 1) trace.push_back(events[id]);
  return trace;
}

double cost_ns(const std::vector<sync::TraceEvent>& trace, sync::AlignerKind kind, sync::Nanoseconds fixed) {
  std::size_t adds = 0;
  for (const auto& event : trace) adds += event.size();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kRepeats; ++i) {
    const auto aligner = sync::make_aligner(kind, fixed);
    for (const auto& event : trace)
      for (const auto& [sense, needed] : event) aligner->add(needed);
  }
  const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
  return took.count() / (kRepeats * static_cast<double>(std::max<std::size_t>(1, adds)));
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Applies every aligner to one trace of latencies and prints the results.");
  std::vector<std::string> logs;
  std::string json, fixed = "40ms";
  unsigned seed = 1;
  app.add_option("LOG", logs, "logs of runs, or their folders; none: a synthetic trace")->check(CLI::ExistingPath);
  app.add_option("--fixed", fixed, "delay of the fixed aligner")->capture_default_str();
  app.add_option("--seed", seed, "of the made trace")->capture_default_str();
  app.add_option("--json", json, "write the table here too");
  sync::parse_or_exit(app, "compare_aligners", argc, argv);

  const auto trace = logs.empty() ? made_trace(seed) : logged_trace(logs);
  if (trace.size() < 64)
    throw std::runtime_error("only " + std::to_string(trace.size()) +
                             " events were presented in two senses; take a longer log");
  const sync::Nanoseconds fixed_delay = sync::parse_duration(fixed);
  nlohmann::json table = nlohmann::json::array();
  std::printf("%zu events\n%-14s %12s %12s %10s %10s %8s %10s\n", trace.size(), "aligner", "async p50/ms",
              "async p95/ms", "added/ms", "delay/ms", "late/%", "ns/event");
  for (const auto kind : {sync::AlignerKind::kFixed, sync::AlignerKind::kQuantile,
                          sync::AlignerKind::kMovingAverage, sync::AlignerKind::kVirtualTime}) {
    const sync::AlignerResult r = sync::simulate_aligner(trace, kind, fixed_delay);
    const double cost = cost_ns(trace, kind, fixed_delay);
    std::printf("%-14s %12.2f %12.2f %10.2f %10.2f %8.2f %10.0f\n", name_of(kind), to_ms(r.asynchrony_p50),
                to_ms(r.asynchrony_p95), to_ms(r.added_mean), to_ms(r.delay_last), 100 * r.late_share, cost);
    table.push_back({{"aligner", name_of(kind)},
                     {"asynchrony_p50_ms", to_ms(r.asynchrony_p50)},
                     {"asynchrony_p95_ms", to_ms(r.asynchrony_p95)},
                     {"added_mean_ms", to_ms(r.added_mean)},
                     {"delay_last_ms", to_ms(r.delay_last)},
                     {"late_share", r.late_share},
                     {"cost_ns", cost}});
  }
  if (!json.empty() && !(std::ofstream(json) << table.dump(2) << "\n"))
    throw std::runtime_error("cannot write " + json + "; name a file in a folder that is there");
  return 0;
} catch (const std::exception& e) {
  return sync::fail("compare_aligners", e);
}
