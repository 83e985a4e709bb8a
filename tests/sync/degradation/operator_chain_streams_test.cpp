// Tests of operator state: each stream has its own, and a new incarnation of the simulation clears it.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <tactus/contact_frame_t.hpp>

#include "sync/degradation/degraded_snapshots.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kMs = 1'000'000;

OperatorChain stack_of(const std::string& attributes, SimTime start = {}) {
  return OperatorChain(parse_profile("<profile><degrade modality=\"thermal\" " + attributes + "/></profile>", "p.xml"),
               "thermal", start);
}

contact_frame_t frame(std::int8_t group, std::int64_t sim_ms, std::int64_t sent_ms, double force_N,
                      std::int64_t incarnation = 1) {
  contact_frame_t m{};
  m.header.sim_time_ns = sim_ms * kMs;
  m.header.publish_time_ns = sent_ms * kMs;
  m.header.run_id = 1;
  m.header.incarnation = incarnation;
  m.clock = {sim_ms * kMs, sent_ms * kMs, 1};
  m.group = group;
  m.pages = m.count = 1;
  m.contacts.resize(1);
  m.contacts[0].contact_id = group;
  m.contacts[0].normal.z = 1;
  m.contacts[0].normal_force_N = static_cast<float>(force_N);
  return m;
}

StreamItem event(std::uint64_t id, std::int64_t ms, std::int64_t incarnation) {
  return {.key = id,
          .is_event = true,
          .incarnation = incarnation,
          .time = sim_time(ms * kMs),
          .arrival = host_time(ms * kMs),
          .signals = {}};
}

// Both groups of CONTACTS as sim_node publishes them: that of the tool at each step, the others 16 ms ahead of their time. Returns the
// instants of the delivered snapshots, by group, ms.
std::map<int, std::vector<std::int64_t>> both_groups(OperatorChain& stack, double (*force_N)(int group, std::int64_t ms)) {
  DegradedSnapshots<contact_frame_t> frames;
  std::map<int, std::vector<std::int64_t>> kept;
  for (std::int64_t ms = 0; ms < 2000; ++ms) {
    if (ms % 16 == 0)
      frames.push(frame(contact_frame_t::OTHER, ms + 16, ms, force_N(1, ms)), host_time(ms * kMs), stack, nullptr);
    frames.push(frame(contact_frame_t::TOOL, ms, ms, force_N(0, ms)), host_time(ms * kMs), stack, nullptr);
    while (const auto m = frames.pop(host_time(ms * kMs)))
      kept[m->first.group].push_back(m->first.header.sim_time_ns / kMs);
  }
  return kept;
}

}  // namespace

TEST_CASE("A rate thins each stream independently") {
  OperatorChain stack = stack_of("rate=\"5Hz\"");
  auto kept = both_groups(stack, [](int, std::int64_t) { return 1.0; });
  REQUIRE(kept[contact_frame_t::TOOL].size() == 10);
  for (std::size_t i = 0; i < 10; ++i) CHECK(kept[contact_frame_t::TOOL][i] == static_cast<std::int64_t>(200 * i));
  CHECK(kept[contact_frame_t::OTHER].size() == 11);
}

TEST_CASE("A deadband compares each stream only with itself") {
  OperatorChain stack = stack_of("deadband=\"10% force\"");
  auto kept = both_groups(stack, [](int group, std::int64_t ms) { return group == 0 && ms >= 1000 ? 2.0 : 1.0; });
  CHECK(kept[contact_frame_t::TOOL] == std::vector<std::int64_t>{0, 1000});
  CHECK(kept[contact_frame_t::OTHER].size() == 1);
}

TEST_CASE("A deadband compares all pages of a snapshot in any order and keeps or drops them together") {
  OperatorChain stack = stack_of("deadband=\"10% force\"");
  DegradedSnapshots<contact_frame_t> frames;
  Decisions decisions;
  std::map<std::int64_t, int> kept;
  for (std::int64_t ms = 0; ms < 200; ++ms) {
    for (int i = 0; i < 3; ++i) {
      const int page = ms % 2 == 0 ? i : 2 - i;
      // Only the last page changes, once.
      contact_frame_t m = frame(contact_frame_t::TOOL, ms, ms, page == 2 && ms >= 100 ? 2 : 1);
      m.contacts[0].contact_id = page;
      m.page = page, m.pages = 3;
      if (ms == 150 && page == 1) continue;  // lost on the wire
      frames.push(m, host_time(ms * kMs), stack, &decisions);
    }
    while (const auto m = frames.pop(host_time(ms * kMs))) ++kept[m->first.header.sim_time_ns / kMs];
  }
  // A snapshot with a missing page is released when four newer ones have arrived. None arrived, so it is never released.
  CHECK(kept == std::map<std::int64_t, int>{{0, 3}, {100, 3}});
  CHECK(decisions.size() == 199);
}

TEST_CASE("A deadband judges a snapshot with a lost page by its received pages after newer ones arrive") {
  OperatorChain stack = stack_of("deadband=\"10% force\"");
  DegradedSnapshots<contact_frame_t> frames;
  std::vector<std::int64_t> kept;
  for (std::int64_t ms = 0; ms < 10; ++ms) {
    contact_frame_t m = frame(contact_frame_t::TOOL, ms, ms, 1);
    m.pages = 2;  // the second page never arrives
    frames.push(m, host_time(ms * kMs), stack, nullptr);
    while (const auto let = frames.pop(host_time(ms * kMs))) kept.push_back(let->first.header.sim_time_ns / kMs);
  }
  CHECK(kept == std::vector<std::int64_t>{0});  // the first; the others contain no change
}

TEST_CASE("The burst length of one stream does not depend on other streams") {
  OperatorChain stack = stack_of("loss=\"20% burst=5\"");
  DegradedSnapshots<contact_frame_t> frames;
  Decisions decisions;
  constexpr int kN = 40'000;
  std::map<std::int64_t, bool> through;
  for (std::int64_t ms = 0; ms < kN; ++ms) {
    frames.push(frame(contact_frame_t::OTHER, ms, ms, 1), host_time(ms * kMs), stack, nullptr);
    frames.push(frame(contact_frame_t::TOOL, ms, ms, 1), host_time(ms * kMs), stack, nullptr);
    while (const auto m = frames.pop(host_time(ms * kMs)))
      if (m->first.group == contact_frame_t::TOOL) through[ms] = true;
  }
  int lost = 0, bursts = 0;
  for (std::int64_t ms = 0; ms < kN; ++ms) {
    const bool gone = !through.contains(ms);
    lost += gone;
    bursts += gone && (ms == 0 || through.contains(ms - 1));
  }
  // Geometric, mean 5: standard deviation sqrt(20), over the bursts counted.
  CHECK(std::abs(static_cast<double>(lost) / bursts - 5) < 5 * std::sqrt(20.0 / bursts));
}

TEST_CASE("A rate continues at once when the world restarts") {
  const bool replayed = GENERATE(false, true);  // the same incarnation from its beginning, or a new one
  OperatorChain stack = stack_of("rate=\"5Hz\"");
  DegradedSnapshots<contact_frame_t> frames;
  std::vector<std::int64_t> kept;
  for (std::int64_t ms = 0; ms < 20'000; ++ms)
    frames.push(frame(contact_frame_t::TOOL, ms, ms, 1), host_time(ms * kMs), stack, nullptr);
  while (frames.pop(host_time(20'000 * kMs))) {
  }
  for (std::int64_t ms = 0; ms < 1000; ++ms) {
    frames.push(frame(contact_frame_t::TOOL, ms, replayed ? ms : 20'000 + ms, 1, replayed ? 1 : 2),
                host_time((20'000 + ms) * kMs), stack, nullptr);
    while (const auto m = frames.pop(host_time((20'000 + ms) * kMs)))
      kept.push_back(m->first.header.sim_time_ns / kMs);
  }
  CHECK(kept == std::vector<std::int64_t>{0, 200, 400, 600, 800});
}

TEST_CASE("The times and the low-pass of a rule restart with the world") {
  OperatorChain stack = stack_of("off=\"true\" from=\"1s\" until=\"2s\"", sim_time(50'000 * kMs));
  const auto dropped = [&](std::int64_t ms, std::int64_t incarnation) {
    return stack.decide(event(1, ms, incarnation)).dropped();
  };
  CHECK_FALSE(dropped(49'900, 1));  // in flight when the rule came into force
  CHECK_FALSE(dropped(50'900, 1));
  CHECK(dropped(51'500, 1));
  CHECK_FALSE(dropped(900, 2));
  CHECK(dropped(1500, 2));
  CHECK_FALSE(dropped(2500, 2));

  OperatorChain smooth = stack_of("lowpass=\"1Hz\"");
  const auto force = [&](double value, std::int64_t ms) {
    return smooth.degraded_value(Quantity::kForce, 7, 0, value, sim_time(ms * kMs), -1, -1, -1, -1);
  };
  CHECK(force(3, 10'000) == 3);
  CHECK(force(1, 0) == 1);
  CHECK(force(2, 100) == Approx(2 - std::exp(-2 * M_PI * 0.1)));
}

TEST_CASE("The longest possible delay holds a stream of 1 kHz without loss") {
  OperatorChain stack = stack_of("delay=\"60s network\"");
  DegradedSnapshots<contact_frame_t> frames;
  std::int64_t next = 0;
  bool in_turn = true;
  for (std::int64_t ms = 0; ms < 62'000; ++ms) {
    frames.push(frame(contact_frame_t::TOOL, ms, ms, 1), host_time(ms * kMs), stack, nullptr);
    while (const auto m = frames.pop(host_time(ms * kMs)))
      in_turn &= m->first.header.sim_time_ns == next++ * kMs && ms == next - 1 + 60'000;
  }
  CHECK(in_turn);
  CHECK(next == 2000);
}
