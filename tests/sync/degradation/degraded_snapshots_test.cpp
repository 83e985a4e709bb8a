// Tests of a degraded input stream: pages, groups, repetitions, delays and changes of the profile.
#include "sync/degradation/degraded_snapshots.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/resampling/contact_stream.h"
#include "sync/clocks/sender_clock.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kEpoch = 5'000'000'000'000;  // on the host's clock

OperatorChain audio_chain(const std::string& attributes) {
  return OperatorChain(parse_profile("<profile><degrade modality=\"audio\" " + attributes + "/></profile>", "p.xml"),
               "audio", {});
}

header_t header(int ms, std::int64_t seq) {
  header_t h{};
  h.sim_time_ns = ms * kMs;
  h.publish_time_ns = kEpoch + ms * kMs;
  h.run_id = 1;
  h.source = 7;
  h.incarnation = 99;
  h.seq = seq;
  return h;
}
sim_clock_t clock_at(int ms) { return {ms * kMs, kEpoch + ms * kMs, 1}; }
HostTime arrival(int ms) { return host_time(kEpoch + ms * kMs + 200'000); }

contact_event_t event(std::int64_t id, int ms) {
  contact_event_t e{};
  e.event_id = id;
  e.contact_id = id;
  e.kind = contact_event_t::HIT;
  e.time_ns = ms * kMs;
  e.approach_speed_m_s = 1;
  return e;
}

// All events younger than 50 ms, as sim_node repeats them.
contact_events_t events_at(int ms, const std::vector<contact_event_t>& all, std::int64_t seq) {
  contact_events_t m{};
  m.header = header(ms, seq);
  m.clock = clock_at(ms);
  m.pages = 1;
  for (const contact_event_t& e : all)
    if (e.time_ns <= ms * kMs && e.time_ns > (ms - 50) * kMs) m.events.push_back(e);
  m.count = static_cast<std::int32_t>(m.events.size());
  return m;
}

contact_frame_t page_at(int ms, int page, int pages, std::int64_t seq) {
  contact_frame_t m{};
  m.header = header(ms, seq);
  m.clock = clock_at(ms);
  m.group = contact_frame_t::OTHER;
  m.page = page;
  m.pages = pages;
  contact_t c{};
  c.contact_id = 100 + page;
  c.normal_force_N = static_cast<float>(ms);
  m.contacts = {c};
  m.count = 1;
  return m;
}

}  // namespace

TEST_CASE("Without a profile every message passes at once and unchanged") {
  OperatorChain none;
  DegradedSnapshots<contact_frame_t> frames;
  EventInbox events(1);
  frames.push(page_at(3, 0, 1, 0), arrival(3), none, nullptr);
  events.push(events_at(3, {event(1, 2)}, 0), arrival(3), none, nullptr);
  const auto f = frames.pop(arrival(3));
  REQUIRE(f);
  CHECK(f->first.contacts.at(0).normal_force_N == 3);
  events.release(arrival(3));
  CHECK(events.take(SimTime::max()).size() == 1);
  CHECK_FALSE(frames.pop(arrival(100)));
}

TEST_CASE("All pages of a snapshot are kept or dropped together") {
  OperatorChain stack = audio_chain("loss=\"50%\"");
  DegradedSnapshots<contact_frame_t> frames;
  Decisions decisions;
  for (int ms = 0; ms < 200; ++ms)
    for (int page = 0; page < 3; ++page)
      frames.push(page_at(ms, page, 3, 3 * ms + page), arrival(ms), stack, &decisions);
  std::map<std::int64_t, int> pages;
  while (const auto m = frames.pop(arrival(1000))) ++pages[m->first.header.sim_time_ns];
  for (const auto& [time, n] : pages) CHECK(n == 3);
  CHECK(decisions.size() == 200);
  CHECK(std::abs(static_cast<int>(pages.size()) - 100) < 5 * std::sqrt(50));
}

TEST_CASE("A profile change between the pages of a snapshot drops only its remaining pages") {
  OperatorChain stack;
  DegradedSnapshots<contact_frame_t> frames;
  for (int ms = 0; ms < 10; ++ms)
    for (int page = 0; page < 3; ++page) {
      if (ms == 5 && page == 1) {
        stack = audio_chain("gain=\"0.5\"");
        frames.change_profile();
      }
      frames.push(page_at(ms, page, 3, 3 * ms + page), arrival(ms), stack, nullptr);
    }
  std::map<std::int64_t, int> pages;
  while (const auto m = frames.pop(arrival(10))) {
    const std::int64_t ms = m->first.header.sim_time_ns / kMs;
    ++pages[ms];
    CHECK(m->first.contacts.at(0).normal_force_N == Approx(ms <= 5 ? ms : 0.5 * static_cast<double>(ms)));
  }
  REQUIRE(pages.size() == 10);
  for (const auto& [ms, n] : pages) CHECK(n == (ms == 5 ? 1 : 3));
}

TEST_CASE("A profile change between the pages of two streams of a channel drops the remaining pages of both") {
  OperatorChain stack;
  DegradedSnapshots<contact_frame_t> frames;
  const auto push = [&](int ms, int page, std::int8_t group) {
    contact_frame_t m = page_at(ms, page, 3, 6 * ms + page);
    m.group = group;
    frames.push(m, arrival(ms), stack, nullptr);
  };
  for (int ms = 0; ms < 10; ++ms)
    for (int page = 0; page < 3; ++page)
      for (const std::int8_t group : {contact_frame_t::OTHER, contact_frame_t::TOOL}) {
        if (ms == 5 && page == 1 && group == contact_frame_t::TOOL) {
          stack = audio_chain("gain=\"0.5\"");
          frames.change_profile();
        }
        push(ms, page, group);
      }
  std::map<std::pair<std::int64_t, int>, std::vector<double>> forces;
  while (const auto m = frames.pop(arrival(10)))
    forces[{m->first.header.sim_time_ns / kMs, m->first.group}].push_back(
        static_cast<double>(m->first.contacts.at(0).normal_force_N));
  REQUIRE(forces.size() == 20);
  for (const auto& [of, pages] : forces) {
    CHECK(pages.size() == (of.first != 5 ? 3u : of.second == contact_frame_t::OTHER ? 2u : 1u));
    for (const double force : pages)
      CHECK(force == Approx(of.first <= 5 ? static_cast<double>(of.first) : 0.5 * static_cast<double>(of.first)));
  }
}

TEST_CASE("While the world is paused, the first complete snapshot after a profile change is delivered") {
  const bool between_pages = GENERATE(true, false);
  OperatorChain stack = audio_chain("off=\"true\"");
  DegradedSnapshots<contact_frame_t> frames;
  for (int k = 0; k < 10; ++k)
    for (int page = 0; page < 3; ++page) {
      if (k == 5 && page == (between_pages ? 1 : 0)) {
        stack = OperatorChain();
        frames.change_profile();
      }
      frames.push(page_at(7, page, 3, 3 * k + page), arrival(7 + k), stack, nullptr);
    }
  int came = 0;
  while (const auto m = frames.pop(arrival(20))) came += m->first.contacts.empty() ? 0 : 1;  // the profile "off" delivers none
  CHECK(came == (between_pages ? 4 : 5) * 3);
}

TEST_CASE("While the world is paused, tool states are delayed and dropped one by one") {
  const bool late = GENERATE(true, false);
  OperatorChain stack = audio_chain(late ? "delay=\"40ms network\"" : "loss=\"50%\"");
  DegradedSnapshots<tool_state_t> tools;
  int came = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    tool_state_t m{};
    m.header = header(ms, ms);
    m.header.sim_time_ns = 7 * kMs;
    m.buttons = ms;
    tools.push(m, arrival(ms), stack, nullptr);
    while (const auto out = tools.pop(arrival(ms))) {
      ++came;
      if (late) CHECK(out->first.buttons == ms - 40);
    }
  }
  if (late)
    CHECK(came == 960);
  else
    CHECK(std::abs(came - 500) < 5 * std::sqrt(250));
}

TEST_CASE("A dropped event is not restored by its repetitions") {
  OperatorChain stack = audio_chain("loss=\"40%\"");
  EventInbox degraded(1);
  Decisions decisions;
  std::vector<contact_event_t> all;
  for (int i = 0; i < 500; ++i) all.push_back(event(1000 + i, 2 * i));
  ContactStream stream(degraded);
  std::set<std::int64_t> heard;
  for (int ms = 0; ms < 1100; ++ms) {
    degraded.push(events_at(ms, all, ms), arrival(ms), stack, &decisions);
    degraded.release(arrival(ms));
    for (const contact_event_t& e : stream.take_events(SimTime::max())) CHECK(heard.insert(e.event_id).second);
  }
  CHECK(decisions.size() == 500);
  const auto dropped = degraded.take_dropped();
  CHECK(heard.size() + dropped.size() == 500);
  for (const contact_event_t& e : dropped) CHECK_FALSE(heard.contains(e.event_id));
  CHECK(std::abs(static_cast<int>(dropped.size()) - 200) < 5 * std::sqrt(120));
}

TEST_CASE("A long network delay delivers all events once, later by the delay, without a restart") {
  const int delay_ms = GENERATE(40, 500, 3000);
  OperatorChain stack = audio_chain("delay=\"" + std::to_string(delay_ms) + "ms network\"");
  EventInbox degraded(1);
  DegradedSnapshots<contact_frame_t> frames;
  std::vector<contact_event_t> all;
  for (int i = 0; i < 100; ++i) all.push_back(event(1 + i, 7 * i));
  ContactStream stream(degraded);
  int heard = 0;
  for (int ms = 0; ms < 1000 + delay_ms; ++ms) {
    degraded.push(events_at(ms, all, ms), arrival(ms), stack, nullptr);
    frames.push(page_at(ms, 0, 1, ms), arrival(ms), stack, nullptr);
    degraded.release(arrival(ms));
    while (const auto m = frames.pop(arrival(ms))) stream.push(m->first, m->second);
    for (const contact_event_t& e : stream.take_events(SimTime::max())) {
      ++heard;
      CHECK(ms * kMs - e.time_ns == delay_ms * kMs);
    }
  }
  CHECK(heard == 100);
  CHECK(stream.restarts() == 0);
  // The contact data are old by the delay; the clock map is current.
  const auto map = stream.map(arrival(1000 + delay_ms));
  REQUIRE(map);
  CHECK(std::abs(to_ns(map->to_sim(host_time(kEpoch + 5 * kMs))) - 5 * kMs) <= kMs / 4);
  CHECK(stream.state_at(sim_time(990 * kMs)).value.at(0).normal_force_N == Approx(990));
}

TEST_CASE("A stream frozen to zero has no contacts") {
  OperatorChain stack = audio_chain("freeze=\"zero\" from=\"10ms\" until=\"20ms\"");
  DegradedSnapshots<contact_frame_t> frames;
  for (int ms = 0; ms < 30; ++ms) frames.push(page_at(ms, 0, 1, ms), arrival(ms), stack, nullptr);
  int n = 0;
  while (const auto m = frames.pop(arrival(100))) {
    const std::int64_t ms = m->first.header.sim_time_ns / kMs;
    CHECK(m->first.contacts.empty() == (ms >= 10 && ms < 20));
    CHECK(m->first.count == static_cast<std::int32_t>(m->first.contacts.size()));
    ++n;
  }
  CHECK(n == 30);
}

TEST_CASE("A modality that is off receives no poses") {
  for (const char* what : {"off=\"true\"", "freeze=\"zero\"", "loss=\"100%\" conceal=\"zero\""}) {
    OperatorChain stack = audio_chain(std::string(what) + " from=\"10ms\" until=\"20ms\"");
    DegradedSnapshots<world_state_t> poses;
    for (int ms = 0; ms < 30; ++ms) {
      world_state_t m{};
      m.header = header(ms, ms);
      m.clock = clock_at(ms);
      m.pages = 1;
      poses.push(m, arrival(ms), stack, nullptr);
    }
    int n = 0;
    while (const auto m = poses.pop(arrival(100))) {
      const std::int64_t ms = m->first.header.sim_time_ns / kMs;
      CHECK((ms < 10 || ms >= 20));
      ++n;
    }
    CHECK(n == 20);
  }
}

TEST_CASE("A log that is played again delivers its events again") {
  OperatorChain stack = audio_chain("delay=\"10ms network\"");
  EventInbox degraded(1);
  int heard = 0;
  for (int round = 0; round < 2; ++round)
    for (int ms = 0; ms < 2000; ++ms) {
      degraded.push(events_at(ms, {event(5, 100)}, ms), arrival(2000 * round + ms), stack, nullptr);
      degraded.release(arrival(2000 * round + ms));
      heard += static_cast<int>(degraded.take(SimTime::max()).size());
    }
  CHECK(heard == 2);
}

TEST_CASE("Changed values are valid in every message") {
  OperatorChain stack = audio_chain("gain=\"-2\"");
  DegradedSnapshots<contact_frame_t> frames;
  frames.push(page_at(3, 0, 1, 0), arrival(3), stack, nullptr);
  CHECK(frames.pop(arrival(3))->first.contacts.at(0).normal_force_N == 0);
  OperatorChain half = audio_chain("gain=\"0.5 velocity\"");
  EventInbox events(1);
  events.push(events_at(3, {event(1, 2)}, 0), arrival(3), half, nullptr);
  events.release(arrival(3));
  CHECK(events.take(SimTime::max()).at(0).approach_speed_m_s == 0.5f);
}

TEST_CASE("A delayed message does not change the estimated clock of its sender") {
  // A sender whose clock is 7 s behind ours, mapped to 50 us; its messages take 300 us.
  constexpr std::int32_t kTheirs = 5, kOurs = 6;
  constexpr Nanoseconds kBehind{7'000'000'000}, kWay{300'000};
  ClockMaps maps(1);
  clock_map_t map{};
  map.header = header(0, 0);
  map.of_clock = kTheirs;
  map.to_clock = kOurs;
  map.at_ns = kEpoch;
  map.offset_ns = -kBehind.count();  // theirs = ours + offset
  map.uncertainty_ns = 50'000;
  maps.observe(map, host_time(kEpoch) + kBehind);
  REQUIRE(maps.read(host_time(kEpoch), kTheirs, kOurs));
  SenderClock clock({1, kOurs, &maps});
  OperatorChain stack = audio_chain(GENERATE("delay=\"40ms network\"", "delay=\"10ms network\" jitter=\"10ms uniform\"", "rate=\"60Hz\""));
  DegradedSnapshots<contact_frame_t> snapshots;
  EventInbox events({1, kOurs, &maps});
  std::size_t heard = 0;
  for (int ms = 0; ms < 500; ++ms) {
    const HostTime sent = host_time(kEpoch + ms * kMs) + kBehind, arrived = sent + kWay;
    contact_frame_t page = page_at(ms, 0, 1, ms);
    contact_events_t message = events_at(ms, {event(1 + ms / 100, ms / 100 * 100)}, ms);
    page.header.clock = message.header.clock = kTheirs;
    snapshots.push(page, arrived, stack, nullptr);
    events.push(message, arrived, stack, nullptr);
    const auto observe = [&](const header_t& h, HostTime at) {
      ++heard;
      CHECK_FALSE(clock.observe(h, at));
      CHECK(clock.read(h.publish_time_ns, arrived).source == SenderClock::ClockSource::kMapped);
      CHECK(at - (host_time(h.publish_time_ns) + kBehind) == kWay);
    };
    while (const auto m = snapshots.pop(arrived)) observe(m->first.header, m->second);
    events.release(arrived);
    const auto mapped = events.map(arrived);
    REQUIRE(mapped);
    CHECK(std::chrono::abs(mapped->to_host(sim_time(ms * kMs)) - sent) <= Nanoseconds(1'000));
  }
  CHECK(heard >= 20);
}
