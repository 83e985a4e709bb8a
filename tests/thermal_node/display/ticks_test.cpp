#include "thermal_node/display/ticks.h"

#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace std::chrono_literals;
using thermal::Tick;
using thermal::Ticks;

namespace {

using tactus::test::kMs;

// A simulation whose time advances with the host's, 1 s behind, and which publishes every millisecond.
struct World {
  sync::ContactStream stream{1};
  std::int64_t host_ms = 1000;
  std::int64_t incarnation = 5;
  std::int64_t seq = 0;
  double rate = 1;
  std::vector<contact_t> contacts;

  sync::HostTime now() const { return sync::host_time(host_ms * kMs); }

  template <class Message>
  void stamp(Message& m) {
    m.header.run_id = 1;
    m.header.incarnation = incarnation;
    m.header.seq = seq++;
    m.header.publish_time_ns = host_ms * kMs;
    m.header.sim_time_ns = (host_ms - 1000) * kMs;
    m.clock.sim_ns = m.header.sim_time_ns;
    m.clock.host_ns = host_ms * kMs;
    m.clock.rate = rate;
  }
  void event(std::int8_t kind, std::int64_t id, std::int64_t at_ms) {
    contact_events_t m{};
    stamp(m);
    m.pages = 1;
    contact_event_t e{};
    e.event_id = id * 10 + kind;
    e.contact_id = id;
    e.kind = kind;
    e.time_ns = at_ms * kMs;
    e.tool = 0;
    e.body_b = 9;
    e.effective_mass_kg = 1;
    m.events = {e};
    m.count = 1;
    stream.push(m, now());
  }
  void run(int ms) {
    for (int i = 0; i < ms; ++i) {
      ++host_ms;
      contact_frame_t m{};
      stamp(m);
      m.group = contact_frame_t::TOOL;
      m.pages = 1;
      m.contacts = contacts;
      m.count = static_cast<int>(contacts.size());
      stream.push(m, now());
    }
  }
  Tick tick(Ticks& ticks) { return ticks.next(stream, now(), now(), 0, 9); }
  // The last of several ticks, one each 20 ms, in which no message arrives.
  Tick last_of(int count, Ticks& ticks) {
    for (; count > 1; --count) host_ms += 20, tick(ticks);
    host_ms += 20;
    return tick(ticks);
  }
};

contact_t touch(std::int64_t id, float force_N) {
  contact_t c{};
  c.contact_id = id;
  c.tool = 0;
  c.body_a = 3;
  c.body_b = 9;
  c.material_a = 2;
  c.material_b = -1;
  c.normal_force_N = force_N;
  c.area_m2 = 1e-5f;
  c.point_count = 1;
  return c;
}

}  // namespace

TEST_CASE("Before the first message a tick is empty") {
  World world;
  Ticks ticks;
  const Tick tick = world.tick(ticks);
  CHECK(tick.contact.status == sync::SampleStatus::kNone);
  CHECK(tick.events.empty());
}

TEST_CASE("Ticks divide simulated time without a gap or an overlap") {
  World world;
  world.run(100);
  Ticks ticks;
  Tick before = world.tick(ticks);
  for (const int ms : {20, 20, 35, 1, 90, 20}) {
    world.run(ms);
    const Tick tick = world.tick(ticks);
    CHECK(tick.sim_begin == before.sim_end);
    CHECK(tick.begin == before.end);
    CHECK(tick.sim_end - tick.sim_begin == std::chrono::milliseconds(ms));
    before = tick;
  }
}

TEST_CASE("Every part of a touch belongs to exactly one tick") {
  // A touch of 7 ms, begun at each millisecond of a tick: the contact times of all ticks add up to 7 ms.
  for (int begin = 100; begin < 120; ++begin) {
    World world;
    Ticks ticks;
    world.run(60);
    world.tick(ticks);
    sync::Nanoseconds sum{0};
    std::size_t events = 0;
    for (int ms = 61; ms < 300; ++ms) {
      // Events of a step are known at its end.
      if (ms == begin + 1) world.contacts = {touch(4, 1)};
      if (ms == begin + 8) world.contacts.clear();
      world.run(1);
      if (ms == begin + 1) world.event(contact_event_t::BEGIN, 4, begin);
      if (ms == begin + 8) world.event(contact_event_t::END, 4, begin + 7);
      if (ms % 20 != 0) continue;
      const Tick tick = world.tick(ticks);
      sum += tick.contact.contact_time;
      events += tick.events.size();
      CHECK((tick.contact.material == 2) == (tick.contact.contact_time > 0ms));
    }
    CHECK(sum == 7ms);
    CHECK(events == 2);
  }
}

TEST_CASE("The contact of a silent simulation is stale after 50 ms") {
  World world;
  Ticks ticks;
  world.contacts = {touch(4, 1)};
  world.run(60);
  CHECK(world.tick(ticks).contact.status != sync::SampleStatus::kStale);
  world.host_ms += 40;
  CHECK(ticks.next(world.stream, world.now(), world.now() - 40ms, 0, 9).contact.status == sync::SampleStatus::kHeld);
  world.host_ms += 20;
  CHECK(ticks.next(world.stream, world.now(), world.now() - 60ms, 0, 9).contact.status == sync::SampleStatus::kStale);
}

TEST_CASE("A paused contact is held and is stale when the simulation stops") {
  World world;
  Ticks ticks;
  world.contacts = {touch(4, 1)};
  world.run(60);
  world.tick(ticks);
  world.run(20);
  const Tick running = world.tick(ticks);
  REQUIRE(running.contact.force_N == Approx(1));
  world.rate = 0;
  world.event(contact_event_t::HIT, 4, 79);  // carries the paused clock
  world.host_ms += 20;
  world.tick(ticks);
  world.host_ms += 20;
  const Tick paused = ticks.next(world.stream, world.now(), world.now(), 0, 9);
  CHECK(paused.sim_begin == paused.sim_end);
  CHECK(paused.end - paused.begin == 20ms);
  CHECK(paused.contact.force_N == Approx(1));
  CHECK(paused.contact.status != sync::SampleStatus::kStale);
  world.host_ms += 200;
  CHECK(ticks.next(world.stream, world.now(), world.now() - 200ms, 0, 9).contact.status == sync::SampleStatus::kStale);
}

TEST_CASE("A contact that is heard again during a pause is held as before the silence") {
  World world;
  Ticks ticks;
  world.contacts = {touch(4, 1)};
  world.run(60);
  world.tick(ticks);
  world.run(20);
  world.rate = 0;
  world.event(contact_event_t::HIT, 4, 79);  // carries the paused clock
  world.last_of(2, ticks);
  world.host_ms += 200;
  REQUIRE(ticks.next(world.stream, world.now(), world.now() - 200ms, 0, 9).contact.status == sync::SampleStatus::kStale);
  const Tick heard = world.tick(ticks);
  CHECK(heard.contact.status != sync::SampleStatus::kStale);
  CHECK(heard.contact.force_N == Approx(1));
}

TEST_CASE("A contact that began in a silence before a pause is present in the pause") {
  World world;
  Ticks ticks;
  world.run(60);
  world.tick(ticks);
  world.host_ms += 200;
  REQUIRE(ticks.next(world.stream, world.now(), world.now() - 200ms, 0, 9).contact.status == sync::SampleStatus::kStale);
  world.contacts = {touch(4, 1)};
  world.rate = 0;
  world.run(1);  // the simulation was paused meanwhile
  const Tick tick = world.last_of(3, ticks);
  CHECK(tick.sim_begin == tick.sim_end);
  CHECK(tick.contact.status != sync::SampleStatus::kStale);
  CHECK(tick.contact.force_N == Approx(1));
  CHECK(tick.contact.contact_time == tick.contact_interval);
}

TEST_CASE("A touch that ended before a pause does not last for the pause") {
  World world;
  Ticks ticks;
  world.contacts = {touch(4, 1)};
  world.run(60);
  world.tick(ticks);
  world.run(10);
  world.contacts.clear();
  world.run(10);
  world.event(contact_event_t::END, 4, 70);
  world.rate = 0;
  world.run(1);
  const Tick tick = world.last_of(3, ticks);
  REQUIRE(tick.sim_begin == tick.sim_end);
  CHECK(tick.contact.contact_time == 0ms);
  CHECK(tick.contact.force_N == 0);
}

TEST_CASE("While a growing delay holds the presentation, the contact of the last interval is held") {
  World world;
  Ticks ticks;
  world.contacts = {touch(4, 1)};
  world.run(60);
  world.tick(ticks);
  world.run(10);
  world.contacts.clear();
  world.run(10);
  world.event(contact_event_t::END, 4, 70);
  const Tick last = world.tick(ticks);
  REQUIRE(last.contact.contact_time > 0ms);
  world.run(20);
  const Tick held = ticks.next(world.stream, world.now(), world.now(), 0, 9, 40ms);
  REQUIRE(held.sim_begin == held.sim_end);
  CHECK(held.contact.contact_time == last.contact.contact_time);
  CHECK(held.contact_interval == last.contact_interval);
}

TEST_CASE("A process that starts in a pause has the contact of that instant") {
  World world;
  Ticks ticks;
  world.contacts = {touch(4, 1)};
  world.rate = 0;
  world.run(1);
  const Tick tick = world.last_of(2, ticks);
  CHECK(tick.contact.status != sync::SampleStatus::kNone);
  CHECK(tick.contact.force_N == Approx(1));
}

TEST_CASE("A restarted simulation begins a new interval") {
  World world;
  Ticks ticks;
  world.run(500);
  world.tick(ticks);
  world.incarnation = 6;
  world.host_ms += 100;  // the silence of a restart
  world.tick(ticks);
  world.run(20);
  const Tick tick = world.tick(ticks);
  CHECK(tick.sim_end - tick.sim_begin == 20ms);
}

TEST_CASE("A process that was stopped for a minute integrates at most two seconds") {
  World world;
  Ticks ticks;
  world.run(100);
  world.tick(ticks);
  world.host_ms += 60'000;
  world.run(1);
  const Tick tick = world.tick(ticks);
  CHECK(tick.sim_end - tick.sim_begin == Ticks::kMaxInterval);
  CHECK(tick.end - tick.begin == 60'001ms);
}
