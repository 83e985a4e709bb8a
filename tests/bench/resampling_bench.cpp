// What resampling costs a node: one tick of a 1 kHz contact stream, by number of live contacts. A node at 1 kHz has
// 1 ms a tick, so 50 us are 5 % of a core.
#include <benchmark/benchmark.h>

#include "sync/contact_stream.h"
#include "sync/decode.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kMs = 1'000'000;

// Pages of at most 6 contacts of one point pair, as they fit into a message.
std::vector<contact_frame_t> frames(std::int64_t step, int contacts) {
  std::vector<contact_frame_t> pages;
  constexpr int kPerPage = 6;
  const int count = std::max(1, (contacts + kPerPage - 1) / kPerPage);
  for (int page = 0; page < count; ++page) {
    contact_frame_t m{};
    m.header.sim_time_ns = step * kMs;
    m.header.publish_time_ns = step * kMs;
    m.header.run_id = m.header.incarnation = 1;
    m.clock = {step * kMs, step * kMs, 1};
    m.page = page, m.pages = count;
    for (int i = page * kPerPage; i < std::min(contacts, (page + 1) * kPerPage); ++i) {
      contact_t c{};
      c.contact_id = i;
      c.normal.z = 1;
      c.point_count = 1;
      c.points.resize(1);
      m.contacts.push_back(c);
    }
    m.count = static_cast<int>(m.contacts.size());
    pages.push_back(m);
  }
  return pages;
}

void resample_a_tick(benchmark::State& state) {
  const int contacts = static_cast<int>(state.range(0));
  ContactStream stream(1);
  std::int64_t step = 0;
  std::vector<std::vector<std::vector<std::uint8_t>>> wire;
  for (int i = 0; i < 256; ++i) {
    wire.emplace_back();
    for (const auto& page : frames(i, contacts)) wire.back().push_back(encode(page));
  }
  for (auto _ : state) {
    if (step == 256) {  // the wire starts over: so does the stream
      step = 0;
      stream = ContactStream(1);
    }
    for (const auto& bytes : wire[static_cast<std::size_t>(step)])
      stream.push(*decode<contact_frame_t>(bytes.data(), bytes.size()), host_time(step * kMs));
    benchmark::DoNotOptimize(stream.state_at(sim_time(step * kMs)));
    benchmark::DoNotOptimize(stream.take_events(sim_time(step * kMs)));
    ++step;
  }
  state.counters["per_contact"] =
      benchmark::Counter(static_cast<double>(contacts), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(resample_a_tick)->Arg(1)->Arg(8)->Arg(32)->Arg(128);

}  // namespace

BENCHMARK_MAIN();
