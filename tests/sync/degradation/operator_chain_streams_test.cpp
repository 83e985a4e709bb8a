// Tests of operator state: each stream has its own, and a new incarnation of the simulation clears it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <tactus/contact_frame_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/degradation/degraded_snapshots.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

OperatorChain thermal_chain(const std::string& attributes, SimTime start = {}) {
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
  OperatorChain stack = thermal_chain("rate=\"5Hz\"");
  auto kept = both_groups(stack, [](int, std::int64_t) { return 1.0; });
  REQUIRE(kept[contact_frame_t::TOOL].size() == 10);
  for (std::size_t i = 0; i < 10; ++i) CHECK(kept[contact_frame_t::TOOL][i] == static_cast<std::int64_t>(200 * i));
  CHECK(kept[contact_frame_t::OTHER].size() == 11);
}

TEST_CASE("A deadband compares each stream only with itself") {
  OperatorChain stack = thermal_chain("deadband=\"10% force\"");
  auto kept = both_groups(stack, [](int group, std::int64_t ms) { return group == 0 && ms >= 1000 ? 2.0 : 1.0; });
  CHECK(kept[contact_frame_t::TOOL] == std::vector<std::int64_t>{0, 1000});
  CHECK(kept[contact_frame_t::OTHER].size() == 1);
}

TEST_CASE("A deadband on force passes every snapshot of poses, which have no forces") {
  OperatorChain stack = thermal_chain("deadband=\"10% force\"");
  DegradedSnapshots<world_state_t> poses;
  int passed = 0;
  for (std::int64_t ms = 0; ms < 160; ms += 16) {
    world_state_t m{};
    m.header.sim_time_ns = m.header.publish_time_ns = ms * kMs;
    m.header.incarnation = 1, m.header.seq = ms;
    m.pages = 1;
    poses.push(m, host_time(ms * kMs), stack, nullptr);
    while (poses.pop(host_time(ms * kMs))) ++passed;
  }
  CHECK(passed == 10);
}

TEST_CASE("A deadband compares all pages of a snapshot in any order and keeps or drops them together") {
  OperatorChain stack = thermal_chain("deadband=\"10% force\"");
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
  OperatorChain stack = thermal_chain("deadband=\"10% force\"");
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
  OperatorChain stack = thermal_chain("loss=\"20% burst=5\"");
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
  OperatorChain stack = thermal_chain("rate=\"5Hz\"");
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

TEST_CASE("A rate continues while the world is paused, by the time of publication") {
  OperatorChain stack = thermal_chain("rate=\"50Hz\"");
  DegradedSnapshots<touch_model_t> models;
  std::vector<std::int64_t> kept;
  // The world runs for a second, stands for five, runs for a second, is set back by half a second and runs on. The hand moves.
  const auto world_ms = [](std::int64_t ms) { return ms <= 1000 ? ms : ms <= 6000 ? 1000 : ms <= 7000 ? ms - 5000 : ms - 5500; };
  for (std::int64_t ms = 0; ms < 8000; ++ms) {
    touch_model_t m{};
    m.header.sim_time_ns = world_ms(ms) * kMs;
    m.header.publish_time_ns = ms * kMs;
    m.header.run_id = m.header.incarnation = 1;
    m.header.seq = ms;
    m.clock = {m.header.sim_time_ns, m.header.publish_time_ns, 1};
    m.pages = 1;
    models.push(m, host_time(ms * kMs), stack, nullptr);
    while (const auto out = models.pop(host_time(ms * kMs))) kept.push_back(out->first.header.seq);
  }
  for (std::int64_t second = 0; second < 8; ++second) {
    const auto in_second = std::count_if(kept.begin(), kept.end(), [&](std::int64_t ms) { return ms / 1000 == second; });
    CAPTURE(second);
    CHECK(in_second >= 49);
    CHECK(in_second <= 52);
  }
  for (std::size_t i = 1; i < kept.size(); ++i) CHECK(kept[i] - kept[i - 1] <= 40);
}

TEST_CASE("While the world is paused, each repetition of a snapshot is decided on as one of its own") {
  const std::string attributes = GENERATE("rate=\"5Hz\"", "loss=\"50%\"");
  OperatorChain stack = thermal_chain(attributes);
  DegradedSnapshots<contact_frame_t> frames;
  int passed = 0, broken = 0;
  constexpr int kRepetitions = 600;  // 60 a second
  for (int i = 0; i < kRepetitions; ++i) {
    const std::int64_t ms = 16 * i;
    for (int page = 0; page < 2; ++page) {
      contact_frame_t m = frame(contact_frame_t::OTHER, 7, ms, 1);
      m.header.seq = 2 * i + page;
      m.page = page, m.pages = 2;
      frames.push(m, host_time(ms * kMs), stack, nullptr);
    }
    int pages = 0;
    while (frames.pop(host_time(ms * kMs))) ++pages;
    passed += pages == 2;
    broken += pages == 1;
  }
  CHECK(broken == 0);
  if (attributes.starts_with("rate"))
    CHECK(std::abs(passed - 48) <= 1);  // 9.6 s
  else
    CHECK(std::abs(passed - kRepetitions / 2) < 5 * std::sqrt(kRepetitions / 4));
}

TEST_CASE("The low-pass of a value continues while the world is paused") {
  OperatorChain stack = thermal_chain("lowpass=\"1Hz position\"");
  DegradedSnapshots<touch_model_t> models;
  double last_m = 0;
  for (std::int64_t ms = 0; ms <= 1000; ++ms) {
    touch_model_t m{};
    m.header.sim_time_ns = 7 * kMs;
    m.header.publish_time_ns = ms * kMs;
    m.header.incarnation = 1, m.header.seq = ms;
    m.pages = m.plane_count = 1;
    m.planes.resize(1);
    m.planes[0].point_m.x = ms > 0 ? 1 : 0;
    models.push(m, host_time(ms * kMs), stack, nullptr);
    while (const auto out = models.pop(host_time(ms * kMs))) last_m = out->first.planes.at(0).point_m.x;
  }
  CHECK(last_m == Approx(1 - std::exp(-2 * M_PI)).epsilon(1e-3));
}

TEST_CASE("The times and the low-pass of a rule restart with the world") {
  OperatorChain stack = thermal_chain("off=\"true\" from=\"1s\" until=\"2s\"", sim_time(50'000 * kMs));
  const auto dropped = [&](std::int64_t ms, std::int64_t incarnation) {
    return stack.decide(event(1, ms, incarnation)).dropped();
  };
  CHECK_FALSE(dropped(49'900, 1));  // in flight when the rule came into force
  CHECK_FALSE(dropped(50'900, 1));
  CHECK(dropped(51'500, 1));
  CHECK_FALSE(dropped(900, 2));
  CHECK(dropped(1500, 2));
  CHECK_FALSE(dropped(2500, 2));

  OperatorChain smooth = thermal_chain("lowpass=\"1Hz\"");
  const auto force = [&](double value, std::int64_t ms) {
    return smooth.degraded_value(Quantity::kForce, 7, 0, value, sim_time(ms * kMs), -1, -1, -1, -1);
  };
  CHECK(force(3, 10'000) == 3);
  CHECK(force(1, 0) == 1);
  CHECK(force(2, 100) == Approx(2 - std::exp(-2 * M_PI * 0.1)));
}

TEST_CASE("The longest possible delay holds a stream of 1 kHz without loss") {
  OperatorChain stack = thermal_chain("delay=\"60s network\"");
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
