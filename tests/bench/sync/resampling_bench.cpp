// Cost of contact streams per modality: messages of a 1 kHz stream decoded, degraded and resampled for its ticks.
//
//    bin/resampling_bench [--json FILE]      a table: time per period of the modality, share of a core, time per contact and tick
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/bus/decode.h"
#include "sync/degradation/degraded_snapshots.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kRecorded_ms = 1000;  // then the same second again, as another incarnation of the simulation
constexpr int kContactsPerPage = 6, kEventsPerPage = 14, kBodiesPerPage = 18;  // the numbers that fit into a message

using Wire = std::vector<std::vector<std::uint8_t>>;  // encoded messages of one millisecond

template <class Message>
Message stamped(std::int64_t ms, int page, int pages) {
  Message m{};
  m.header.sim_time_ns = m.header.publish_time_ns = ms * kMs;
  m.header.run_id = m.header.incarnation = 1;
  m.header.seq = ms * 100 + page;
  m.clock = {ms * kMs, ms * kMs, 1};
  m.page = page, m.pages = pages;
  return m;
}

int pages_of(int things, int per_page) { return std::max(1, (things + per_page - 1) / per_page); }

// All contacts last; the force of each oscillates, so that a deadband has something to compare.
Wire contacts_at(std::int64_t ms, int contacts) {
  Wire wire;
  const int pages = pages_of(contacts, kContactsPerPage);
  for (int page = 0; page < pages; ++page) {
    auto m = stamped<contact_frame_t>(ms, page, pages);
    for (int i = page * kContactsPerPage; i < std::min(contacts, (page + 1) * kContactsPerPage); ++i) {
      contact_t c{};
      c.contact_id = i;
      c.body_a = i, c.body_b = 1000;
      c.normal.z = 1;
      c.normal_force_N = static_cast<float>(1 + (ms * (i + 1)) % 97 * 0.01);
      c.sliding_velocity_m_s.x = static_cast<float>((ms * (i + 3)) % 89 * 0.001);
      c.point_count = 1;
      c.points.resize(1);
      m.contacts.push_back(c);
    }
    m.count = static_cast<int>(m.contacts.size());
    wire.push_back(encode(m));
  }
  return wire;
}

// Each contact hits four times a second; every event is repeated for 50 ms.
Wire events_at(std::int64_t ms, int contacts) {
  std::vector<contact_event_t> young;
  for (std::int64_t t = std::max<std::int64_t>(0, ms - 49); t <= ms; ++t)
    for (int i = 0; i < contacts; ++i)
      if ((t + 8 * i) % 250 == 0) {
        contact_event_t e{};
        e.event_id = t * 1000 + i;
        e.contact_id = i;
        e.kind = contact_event_t::HIT;
        e.time_ns = t * kMs;
        e.body_a = i, e.body_b = 1000;
        e.effective_mass_kg = 1;
        e.normal.z = 1;
        young.push_back(e);
      }
  Wire wire;
  const int pages = young.empty() ? 0 : pages_of(static_cast<int>(young.size()), kEventsPerPage);
  for (int page = 0; page < pages; ++page) {
    auto m = stamped<contact_events_t>(ms, page, pages);
    const auto begin = static_cast<std::size_t>(page * kEventsPerPage);
    m.events.assign(young.begin() + static_cast<std::ptrdiff_t>(begin),
                    young.begin() + static_cast<std::ptrdiff_t>(std::min(young.size(), begin + kEventsPerPage)));
    m.count = static_cast<int>(m.events.size());
    wire.push_back(encode(m));
  }
  return wire;
}

Wire bodies_at(std::int64_t ms, int bodies) {
  Wire wire;
  const int pages = pages_of(bodies, kBodiesPerPage);
  for (int page = 0; page < pages; ++page) {
    auto m = stamped<world_state_t>(ms, page, pages);
    for (int i = page * kBodiesPerPage; i < std::min(bodies, (page + 1) * kBodiesPerPage); ++i) {
      body_state_t b{};
      b.body = i;
      b.position_m.x = static_cast<double>(ms) * 1e-3;
      b.orientation.w = 1;
      b.velocity_m_s.x = 1;
      m.bodies.push_back(b);
    }
    m.count = static_cast<int>(m.bodies.size());
    wire.push_back(encode(m));
  }
  return wire;
}

struct RecordedSecond {
  std::vector<Wire> contacts, events, bodies;  // by millisecond
  explicit RecordedSecond(int n) {
    for (std::int64_t ms = 0; ms < kRecorded_ms; ++ms) {
      contacts.push_back(contacts_at(ms, n));
      events.push_back(events_at(ms, n));
      bodies.push_back(ms % 16 == 0 ? bodies_at(ms, n) : Wire{});
    }
  }
};

OperatorChain chain_of(bool degraded) {
  if (!degraded) return {};
  return OperatorChain(
      parse_profile(R"(<profile><degrade modality="m" delay="5ms network" jitter="2ms normal" loss="5% burst=3"
                                deadband="10% force floor=0.01N"/></profile>)",
                    "bench"),
      "m", SimTime{});
}

// An endpoint that receives one millisecond of messages at a time.
struct StreamBench {
  OperatorChain chain;
  DegradedSnapshots<contact_frame_t> contacts;
  DegradedSnapshots<world_state_t> world;
  EventInbox events{1};
  Decisions decisions;
  ContactStream stream{events};
  BodyHistory bodies{1};

  explicit StreamBench(bool degraded) : chain(chain_of(degraded)) {}
  void take_events(const Wire& wire, HostTime now) {
    for (const auto& bytes : wire)
      events.push(*decode<contact_events_t>(bytes.data(), bytes.size()), now, chain, &decisions);
    events.release(now);
  }
  template <class Message, class Degraded, class Sink>
  void take(const Wire& wire, HostTime now, Degraded& degraded, Sink& sink) {
    for (const auto& bytes : wire)
      degraded.push(*decode<Message>(bytes.data(), bytes.size()), now, chain, &decisions);
    while (const auto m = degraded.pop(now)) sink.push(m->first, m->second);
    decisions.clear();
  }
};

// reads: the streams of the second to receive; render: the requests at a tick. One iteration is one period.
template <class Read, class Render>
void read_and_render(benchmark::State& state, int period_ms, const Read& read, const Render& render) {
  const auto n = static_cast<int>(state.range(0));
  const bool degraded = state.range(1) != 0;
  static std::map<int, RecordedSecond> seconds;
  const RecordedSecond& second = seconds.try_emplace(n, n).first->second;
  auto s = std::make_unique<StreamBench>(degraded);
  std::int64_t ms = 0;
  for (auto _ : state) {
    if (ms + period_ms > kRecorded_ms) {
      state.PauseTiming();
      ms = 0;
      s = std::make_unique<StreamBench>(degraded);
      state.ResumeTiming();
    }
    for (int i = 0; i < period_ms; ++i, ++ms) read(*s, second, static_cast<std::size_t>(ms), host_time(ms * kMs));
    render(*s, sim_time(ms * kMs), n);
  }
  state.counters["period_ms"] = period_ms;
}

// One line per benchmark: the figures of interest.
class Table : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    std::printf("%-18s %9s %9s %9s %14s %11s %16s\n", "sense", "contacts", "degraded", "period_ms",
                "us_per_period", "core_%", "ns_per_contact");
    return true;
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& r : runs) {
      int contacts = 0, degraded = 0;
      std::sscanf(r.run_name.args.c_str(), "contacts:%d/degraded:%d", &contacts, &degraded);
      const double period_ms = r.counters.at("period_ms"), us = r.GetAdjustedCPUTime();
      std::printf("%-18s %9d %9s %9.0f %14.2f %11.3f %16.1f\n", r.run_name.function_name.c_str(), contacts,
                  degraded ? "yes" : "no", period_ms, us, us / period_ms / 10, us * 1000 / contacts);
    }
  }
};

void read_contacts(StreamBench& s, const RecordedSecond& second, std::size_t ms, HostTime now) {
  s.take_events(second.events[ms], now);
  s.take<contact_frame_t>(second.contacts[ms], now, s.contacts, s.stream);
}

// Events and state of all contacts, a thousand times per second.
void every_millisecond(benchmark::State& state) {
  read_and_render(state, 1, read_contacts, [](StreamBench& s, SimTime t, int) {
    benchmark::DoNotOptimize(s.stream.take_events(t));
    benchmark::DoNotOptimize(s.stream.state_at(t - Nanoseconds(8 * kMs)));
  });
}

// As audio_node: the events alone; a block of 128 samples at 48 kHz is 2.7 ms.
void audio_node(benchmark::State& state) {
  read_and_render(
      state, 3,
      [](StreamBench& s, const RecordedSecond& second, std::size_t ms, HostTime now) {
        s.take_events(second.events[ms], now);
      },
      [](StreamBench& s, SimTime t, int) { benchmark::DoNotOptimize(s.stream.take_events(t)); });
}

// As thermal_node: the integral over its tick.
void thermal_node(benchmark::State& state) {
  read_and_render(state, 20, read_contacts, [](StreamBench& s, SimTime t, int) {
    benchmark::DoNotOptimize(s.stream.take_events(t));
    benchmark::DoNotOptimize(s.stream.integral(t - Nanoseconds(25 * kMs), t - Nanoseconds(5 * kMs), 0, 1000));
  });
}

// As visual_node: the events, and as many body poses as there are contacts.
void visual_node(benchmark::State& state) {
  read_and_render(
      state, 16,
      [](StreamBench& s, const RecordedSecond& second, std::size_t ms, HostTime now) {
        s.take_events(second.events[ms], now);
        s.take<world_state_t>(second.bodies[ms], now, s.world, s.bodies);
      },
      [](StreamBench& s, SimTime t, int n) {
        benchmark::DoNotOptimize(s.stream.take_events(t));
        for (int i = 0; i < n; ++i) benchmark::DoNotOptimize(s.bodies.pose(i, t));
      });
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"contacts", "degraded"})->Unit(benchmark::kMicrosecond);
  for (const int degraded : {0, 1})
    for (const int n : {1, 8, 32, 128}) b->Args({n, degraded});
}
BENCHMARK(every_millisecond)->Apply(sizes);
BENCHMARK(audio_node)->Apply(sizes);
BENCHMARK(thermal_node)->Apply(sizes);
BENCHMARK(visual_node)->Apply(sizes);

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--json") == 0 && i + 1 == argc)
      return std::fprintf(stderr, "resampling_bench: --json needs a file\n"), 1;
  std::vector<std::string> words{argv[0]};
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--json") == 0 && i + 1 < argc)
      words.insert(words.end(), {std::string("--benchmark_out=") + argv[++i], "--benchmark_out_format=json"});
    else
      words.push_back(argv[i]);
  }
  std::vector<char*> pointers;
  for (std::string& w : words) pointers.push_back(w.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 1;
  Table table;
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
  return 0;
}
