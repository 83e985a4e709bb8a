// Tests of resampling contacts and contact events.
#include "sync/resampling/contact_stream.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/header_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kStreamRun = 7;

header_t header(std::int64_t sim_ns, std::int64_t incarnation = 1) {
  header_t h{};
  h.sim_time_ns = sim_ns;
  h.publish_time_ns = sim_ns + 1'000 * kMs;
  h.run_id = kStreamRun;
  h.incarnation = incarnation;
  return h;
}

contact_event_t event(std::int64_t id, std::int64_t contact, std::int8_t kind, std::int64_t time_ns) {
  contact_event_t e{};
  e.event_id = id;
  e.contact_id = contact;
  e.kind = kind;
  e.time_ns = time_ns;
  e.body_a = 0, e.body_b = 1;
  e.material_a = 3, e.material_b = 4;
  e.normal.z = 1;
  e.approach_speed_m_s = 0.5f;
  e.effective_mass_kg = 0.2f;
  return e;
}

contact_events_t events(std::int64_t sim_ns, std::vector<contact_event_t> list, std::int64_t incarnation = 1) {
  contact_events_t m{};
  m.header = header(sim_ns, incarnation);
  m.clock = {sim_ns, sim_ns + 1'000 * kMs, 1};
  m.pages = 1;
  m.events = std::move(list);
  m.count = static_cast<int>(m.events.size());
  return m;
}

contact_t contact(std::int64_t id, float force) {
  contact_t c{};
  c.contact_id = id;
  c.body_a = 0, c.body_b = 1;
  c.material_a = 3, c.material_b = 4;
  c.normal.z = 1;
  c.normal_force_N = force;
  c.area_m2 = force * 1e-5f;
  c.point_count = 1;
  c.points.resize(1);
  return c;
}

contact_frame_t frame(std::int64_t sim_ns, std::vector<contact_t> list, int page = 0, int pages = 1,
                      std::int64_t incarnation = 1) {
  contact_frame_t m{};
  m.header = header(sim_ns, incarnation);
  m.clock = {sim_ns, sim_ns + 1'000 * kMs, 1};
  m.group = contact_frame_t::TOOL;
  m.page = page, m.pages = pages;
  m.contacts = std::move(list);
  m.count = static_cast<int>(m.contacts.size());
  return m;
}

HostTime at(std::int64_t sim_ns) { return host_time(sim_ns + 1'000 * kMs); }

}  // namespace

TEST_CASE("A repeated event is delivered once, in its tick") {
  ContactStream stream(kStreamRun);
  for (int i = 0; i < 50; ++i)
    stream.push(events((10 + i) * kMs, {event(1, 1, contact_event_t::BEGIN, 9'500'000)}), at((10 + i) * kMs));
  CHECK(stream.take_events(sim_time(9 * kMs)).empty());
  const auto due = stream.take_events(sim_time(10 * kMs));
  REQUIRE(due.size() == 1);
  CHECK(due[0].time_ns == 9'500'000);
  CHECK(stream.take_events(sim_time(1000 * kMs)).empty());
}

TEST_CASE("Events are delivered once and in order of time when messages are lost, repeated and reordered") {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    // The oracle: the plain list of events.
    std::vector<contact_event_t> truth;
    for (int i = 0; i < 60; ++i)
      truth.push_back(event(100 + i, i / 2, i % 2 ? contact_event_t::END : contact_event_t::BEGIN,
                            std::uniform_int_distribution<std::int64_t>(0, 200 * kMs)(random)));
    // Every step repeats the events younger than 50 ms. 30 % of the messages are lost, some arrive twice, and all are shuffled by 5 ms.
    std::vector<std::pair<std::int64_t, contact_events_t>> wire;
    for (std::int64_t step = 0; step < 260; ++step) {
      std::vector<contact_event_t> young;
      for (const auto& e : truth)
        if (e.time_ns <= step * kMs && e.time_ns > (step - 50) * kMs) young.push_back(e);
      if (random() % 10 < 3) continue;
      const std::int64_t arrival = step * kMs + static_cast<std::int64_t>(random() % (5 * kMs));
      wire.emplace_back(arrival, events(step * kMs, young));
      if (random() % 4 == 0) wire.emplace_back(arrival + 2 * kMs, events(step * kMs, young));
    }
    std::sort(wire.begin(), wire.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    ContactStream stream(kStreamRun);
    std::vector<std::int64_t> got;
    for (const auto& [arrival, message] : wire) {
      stream.push(message, at(arrival));
      std::int64_t last = -1;
      for (const auto& e : stream.take_events(sim_time(message.header.sim_time_ns + 1))) {
        CHECK(e.time_ns >= last);
        last = e.time_ns;
        got.push_back(e.event_id);
      }
    }
    for (const auto& e : stream.take_events(SimTime::max())) got.push_back(e.event_id);
    std::sort(got.begin(), got.end());
    REQUIRE(got.size() == truth.size());
    CHECK(std::adjacent_find(got.begin(), got.end()) == got.end());
  }
}

TEST_CASE("A sampled state has the status exact, interpolated, held, stale or none") {
  ContactStream stream(kStreamRun);
  CHECK(stream.state_at(sim_time(0)).status == SampleStatus::kNone);
  stream.push(frame(10 * kMs, {contact(1, 2)}), at(10 * kMs));
  stream.push(frame(20 * kMs, {contact(1, 4)}), at(20 * kMs));
  CHECK(stream.state_at(sim_time(10 * kMs)).status == SampleStatus::kExact);
  const auto middle = stream.state_at(sim_time(15 * kMs));
  CHECK(middle.status == SampleStatus::kInterpolated);
  REQUIRE(middle.value.size() == 1);
  CHECK(middle.value[0].normal_force_N == Approx(3));
  CHECK(stream.state_at(sim_time(60 * kMs)).status == SampleStatus::kHeld);
  CHECK(stream.state_at(sim_time(71 * kMs)).status == SampleStatus::kStale);
}

TEST_CASE("A snapshot is used only when all its pages have arrived, in any order") {
  ContactStream stream(kStreamRun);
  stream.push(frame(1 * kMs, {contact(1, 1), contact(2, 1)}), at(1 * kMs));
  stream.push(frame(2 * kMs, {contact(2, 1)}, 1, 2), at(2 * kMs));
  CHECK(stream.state_at(sim_time(2 * kMs)).value.size() == 2);
  stream.push(frame(2 * kMs, {}, 0, 2), at(2 * kMs));
  const auto now = stream.state_at(sim_time(2 * kMs));
  REQUIRE(now.value.size() == 1);
  CHECK(now.value[0].contact_id == 2);
}

TEST_CASE("Up to 40 incomplete snapshots are completed by late pages") {
  ContactStream stream(kStreamRun);
  for (int ms = 0; ms < 40; ++ms) stream.push(frame(ms * kMs, {contact(1, static_cast<float>(ms * ms))}, 0, 2), at(ms * kMs));
  for (int ms = 39; ms >= 0; --ms) stream.push(frame(ms * kMs, {}, 1, 2), at((80 - ms) * kMs));
  for (int ms = 0; ms < 40; ++ms) {
    const auto state = stream.state_at(sim_time(ms * kMs));
    CHECK(state.status == SampleStatus::kExact);
    REQUIRE(state.value.size() == 1);
    CHECK(state.value[0].normal_force_N == static_cast<float>(ms * ms));
  }
}

TEST_CASE("Interpolation does not cross a begin or an end") {
  ContactStream stream(kStreamRun);
  stream.push(frame(10 * kMs, {}), at(10 * kMs));
  stream.push(events(20 * kMs, {event(1, 1, contact_event_t::BEGIN, 15 * kMs)}), at(20 * kMs));
  stream.push(frame(20 * kMs, {contact(1, 2)}), at(20 * kMs));
  stream.push(events(30 * kMs, {event(2, 1, contact_event_t::END, 25 * kMs)}), at(30 * kMs));
  CHECK(stream.state_at(sim_time(14 * kMs)).value.empty());
  CHECK(stream.state_at(sim_time(16 * kMs)).value.size() == 1);
  CHECK(stream.state_at(sim_time(24 * kMs)).value.size() == 1);
  CHECK(stream.state_at(sim_time(26 * kMs)).value.empty());
}

TEST_CASE("A restart of the simulation ends all contacts, and messages of the old one are ignored") {
  ContactStream stream(kStreamRun);
  stream.push(frame(10 * kMs, {contact(1, 2)}, 0, 1, 1), at(10 * kMs));
  stream.push(frame(1 * kMs, {}, 0, 1, 2), at(90 * kMs));
  CHECK(stream.restarts() == 1);
  CHECK(stream.state_at(sim_time(1 * kMs)).value.empty());
  stream.push(frame(12 * kMs, {contact(1, 2)}, 0, 1, 1), at(91 * kMs));
  CHECK(stream.state_at(sim_time(12 * kMs)).value.empty());
  CHECK(stream.restarts() == 1);
}

TEST_CASE("A replayed log that restarts is a new epoch of the same incarnation") {
  ContactStream stream(kStreamRun);
  stream.push(frame(5000 * kMs, {contact(1, 2)}), at(5000 * kMs));
  stream.push(events(5000 * kMs, {event(1, 1, contact_event_t::BEGIN, 4999 * kMs)}), at(5000 * kMs));
  CHECK(stream.take_events(SimTime::max()).size() == 1);
  stream.push(events(10 * kMs, {event(1, 1, contact_event_t::BEGIN, 9 * kMs)}), at(5100 * kMs));
  CHECK(stream.restarts() == 1);
  CHECK(stream.take_events(SimTime::max()).size() == 1);
}

TEST_CASE("Messages of another run are mapped to the own clock by their arrival") {
  ContactStream stream(kStreamRun + 1);  // so that the messages above belong to another run
  // Their clock runs 1000 s behind ours; latency 1 ms, once 0.1 ms.
  const auto ours = [](std::int64_t theirs) { return host_time(theirs + 1'000'000 * kMs); };
  for (std::int64_t step = 0; step < 100; ++step) {
    const auto m = frame(step * kMs, {});
    const std::int64_t latency = step == 50 ? 100'000 : kMs;
    stream.push(m, ours(m.header.publish_time_ns + latency));
  }
  const HostTime now = ours(1'100 * kMs);
  const auto map = stream.map(now);
  REQUIRE(map);
  const Nanoseconds error = map->to_host(sim_time(99 * kMs)) - ours(1'099 * kMs);
  // The bias is the smallest latency, plus up to 10 us of drift at 200 ppm in the 50 ms since.
  CHECK(error >= Nanoseconds(100'000));
  CHECK(error <= Nanoseconds(100'000 + 12'000));
}

TEST_CASE("The integral over a tick is the time average of force and area during contact") {
  ContactStream stream(kStreamRun);
  for (std::int64_t step = 0; step <= 40; ++step)
    stream.push(frame(step * kMs, step >= 10 && step < 20 ? std::vector{contact(1, 3)} : std::vector<contact_t>{}),
                at(step * kMs));
  stream.push(events(40 * kMs, {event(1, 1, contact_event_t::BEGIN, 9'500'000),
                                event(2, 1, contact_event_t::END, 19'500'000)}),
              at(40 * kMs));
  const auto tick = stream.integral(sim_time(0), sim_time(20 * kMs), 0, 1);
  CHECK(tick.contact_time == Nanoseconds(10 * kMs));
  CHECK(tick.force_N == Approx(1.5));
  CHECK(tick.area_m2 == Approx(1.5e-5));
  CHECK(tick.body == 0);
  CHECK(tick.material == 3);
  CHECK(stream.integral(sim_time(20 * kMs), sim_time(40 * kMs), 0, 1).contact_time == Nanoseconds(0));
  CHECK(stream.integral(sim_time(0), sim_time(20 * kMs), 5, 1).contact_time == Nanoseconds(0));
}

TEST_CASE("The integral has a part for each touched body, and the parts add up to the total") {
  ContactStream stream(kStreamRun);
  contact_t first = contact(1, 3), second = contact(2, 1), same = contact(3, 2);
  second.body_a = 7, second.material_a = 9;
  for (std::int64_t step = 0; step <= 20; ++step) {
    std::vector<contact_t> list{first};
    if (step >= 10) list = {first, second, same};
    stream.push(frame(step * kMs, list), at(step * kMs));
  }
  const auto tick = stream.integral(sim_time(0), sim_time(20 * kMs), 0, 1);
  REQUIRE(tick.parts.size() == 2);
  CHECK(tick.parts[0].body == 0);
  CHECK(tick.parts[0].material == 3);
  CHECK(tick.parts[0].contact_time == Nanoseconds(20 * kMs));
  CHECK(tick.parts[0].force_N == Approx(3 + 2 * 0.5));
  CHECK(tick.parts[1].body == 7);
  CHECK(tick.parts[1].material == 9);
  CHECK(tick.parts[1].contact_time == Nanoseconds(10 * kMs));
  CHECK(tick.parts[1].force_N == Approx(0.5));
  CHECK(tick.parts[1].area_m2 == Approx(0.5e-5));
  CHECK(tick.force_N == Approx(4.5));
}

TEST_CASE("A contact of 3 ms between two snapshots is integrated from its events") {
  ContactStream stream(kStreamRun);
  stream.push(frame(0, {}), at(0));
  stream.push(frame(20 * kMs, {}), at(20 * kMs));
  stream.push(
      events(20 * kMs, {event(1, 1, contact_event_t::BEGIN, 5 * kMs), event(2, 1, contact_event_t::END, 8 * kMs)}),
      at(20 * kMs));
  const auto tick = stream.integral(sim_time(0), sim_time(20 * kMs), 0, 1);
  CHECK(tick.contact_time == Nanoseconds(3 * kMs));
  CHECK(tick.force_N == Approx(0.2 * 0.5 / 0.020));  // m v over the tick
  CHECK(tick.material == 3);
}

TEST_CASE("A snapshot far in the future is rejected, and the next valid one is accepted") {
  ContactStream stream(kStreamRun);
  stream.push(frame(10 * kMs, {contact(1, 1)}), at(10 * kMs));
  SECTION("the clock of the forged snapshot is correct") {
    contact_frame_t forged = frame(10 * kMs, {contact(9, 9)});
    forged.header.sim_time_ns = 3'600'000 * kMs;
    stream.push(forged, at(10 * kMs));
    CHECK(stream.refused() == 1);
  }
  SECTION("the clock of the forged snapshot matches its false time") {
    contact_frame_t forged = frame(3'600'000 * kMs, {contact(9, 9)});
    forged.header.publish_time_ns = 1'010 * kMs;
    forged.clock.host_ns = 1'010 * kMs;
    stream.push(forged, at(10 * kMs));
  }
  SECTION("a snapshot less than a second ahead is kept and blocks no later one") {
    contact_frame_t forged = frame(10 * kMs, {contact(9, 9)});
    forged.header.sim_time_ns = 900 * kMs;
    stream.push(forged, at(10 * kMs));
    CHECK(stream.refused() == 0);
  }
  stream.push(frame(20 * kMs, {contact(1, 2)}), at(20 * kMs));
  const auto state = stream.state_at(sim_time(20 * kMs));
  CHECK(state.status == SampleStatus::kExact);
  REQUIRE(state.value.size() == 1);
  CHECK(state.value[0].contact_id == 1);
}

TEST_CASE("A forged first message is discarded after contradicting messages") {
  ContactStream stream(kStreamRun);
  contact_frame_t forged = frame(3'600'000 * kMs, {contact(9, 9)});
  forged.header.publish_time_ns = forged.clock.host_ns = 1'000 * kMs;
  contact_events_t lie = events(3'600'000 * kMs, {event(77, 7, contact_event_t::HIT, 3'600'000 * kMs)});
  lie.header.publish_time_ns = lie.clock.host_ns = 1'000 * kMs;
  stream.push(forged, at(0));
  stream.push(lie, at(0));
  for (int ms = 1; ms <= 310; ++ms) stream.push(frame(ms * kMs, {contact(1, 1)}), at(ms * kMs));
  const auto state = stream.state_at(sim_time(310 * kMs));
  REQUIRE(state.value.size() == 1);
  CHECK(state.value[0].contact_id == 1);
  CHECK(stream.take_events(SimTime::max()).empty());
}

TEST_CASE("A snapshot published 20 ms ahead is accepted at any speed of the simulation") {
  for (const double rate : {0.01, 1.0, 5.0}) {
    ContactStream stream(kStreamRun);
    for (int ms = 0; ms < 3000; ms += 16) {
      const auto sim_ns = static_cast<std::int64_t>(ms * rate * kMs);
      contact_frame_t m = frame(sim_ns + 20 * kMs, {contact(1, 1)});
      m.header.publish_time_ns = (ms + 1'000) * kMs;
      m.clock = {sim_ns, (ms + 1'000) * kMs, rate};
      stream.push(m, at(ms * kMs));
    }
    CHECK(stream.refused() == 0);
    CHECK(stream.restarts() == 0);
  }
}

TEST_CASE("Events far in the future are rejected, current ones are delivered") {
  ContactStream stream(kStreamRun);
  std::vector<contact_event_t> lies;
  for (int i = 0; i < 5000; ++i) lies.push_back(event(1000 + i, i, contact_event_t::HIT, 3'600'000 * kMs + i));
  stream.push(events(10 * kMs, {event(1, 1, contact_event_t::HIT, 9 * kMs)}), at(10 * kMs));
  stream.push(events(10 * kMs, lies), at(10 * kMs));
  CHECK(stream.refused() == 5000);
  const auto due = stream.take_events(SimTime::max());
  REQUIRE(due.size() == 1);
  CHECK(due[0].event_id == 1);
}

TEST_CASE("When too many events are pending, the latest are dropped") {
  ContactStream stream(kStreamRun);
  std::vector<contact_event_t> early, late;
  for (int i = 0; i < 5000; ++i) late.push_back(event(10'000 + i, i, contact_event_t::HIT, 500 * kMs + i));
  for (int i = 0; i < 10; ++i) early.push_back(event(i, i, contact_event_t::HIT, 9 * kMs + i));
  stream.push(events(10 * kMs, late), at(10 * kMs));
  stream.push(events(10 * kMs, early), at(10 * kMs));
  CHECK(stream.take_events(sim_time(10 * kMs)).size() == 10);
}

TEST_CASE("Contacts are kept for a modality that presents up to 10 s late") {
  const std::int64_t late = GENERATE(150, 2'000, 10'000) * kMs;
  ContactStream stream(kStreamRun);
  for (std::int64_t ms = 0; ms < 12'000; ++ms) {
    stream.extend_history(Nanoseconds(late));
    contact_t touched = contact(1, 1e-3f * static_cast<float>(ms));
    touched.tool = 0;
    stream.push(frame(ms * kMs, {touched}), at(ms * kMs));
    const std::int64_t end = ms * kMs - late, begin = end - 20 * kMs;
    if (begin < 0 || ms % 20 != 0) continue;
    const auto felt = stream.integral(sim_time(begin), sim_time(end), 0);
    REQUIRE((felt.status == SampleStatus::kExact || felt.status == SampleStatus::kInterpolated));
    // Each snapshot holds for its millisecond: the result is the mean of twenty.
    REQUIRE(felt.force_N == Approx(1e-3 * (static_cast<double>(begin / kMs) + 9.5)).epsilon(1e-5));
  }
}
