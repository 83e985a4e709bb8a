// Tests of the hits that are due in a tick.
#include "audio_node/excitation/due_hits.h"

#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <vector>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::audio;
using tactus::test::kMillisecond;

namespace {

const sync::LatePolicy kLate{sync::LateRule::kPlayWithFade, sync::Nanoseconds(50'000), 30 * kMillisecond};

sync::HostTime due_ms(int ms) { return sync::host_time(1'000'000'000) + ms * kMillisecond; }

// A loop of ticks of 1 ms, each with time for some hits. A hit is to be heard at its own time.
struct Loop {
  sync::EventInbox inbox{1};
  std::int64_t seq = 0;
  std::vector<std::int64_t> struck, dropped;
  std::vector<sync::HostTime> scheduled;

  void push(std::int64_t id, int at_ms, std::int8_t kind = contact_event_t::HIT) {
    contact_events_t m{};
    m.header.run_id = m.header.incarnation = 1;
    m.header.seq = seq++;
    m.header.publish_time_ns = sync::to_ns(due_ms(0));
    m.clock = {0, sync::to_ns(due_ms(0)), 1};
    contact_event_t e{};
    e.event_id = id;
    e.kind = kind;
    e.time_ns = (at_ms * kMillisecond).count();
    m.events.push_back(e);
    m.count = 1;
    inbox.push(m, due_ms(0));
  }
  int tick(int ms, int time_for) {
    return strike_due_hits(inbox, sync::SimTime::max(), due_ms(ms), kLate,
                           HitActions{[](const contact_event_t& e) { return due_ms(0) + sync::Nanoseconds(e.time_ns); },
                                      [&] { return --time_for > 0; },
                                      [&](const contact_event_t& e, sync::HostTime t) { struck.push_back(e.event_id), scheduled.push_back(t); },
                                      [&](const contact_event_t& e, sync::HostTime) { dropped.push_back(e.event_id); }});
  }
};

}  // namespace

TEST_CASE("Hits beyond the time of a tick are struck in the next ticks, in order of their time") {
  Loop loop;
  for (int i = 0; i < 10; ++i) loop.push(i, 20 - i);
  CHECK(loop.tick(0, 3) == 3);
  CHECK(loop.struck == std::vector<std::int64_t>{9, 8, 7});
  for (int ms = 1; ms < 4; ++ms) loop.tick(ms, 3);
  CHECK(loop.struck == std::vector<std::int64_t>{9, 8, 7, 6, 5, 4, 3, 2, 1, 0});
  CHECK(loop.scheduled.back() == due_ms(20));
  CHECK(loop.dropped.empty());
}

TEST_CASE("A tick without time strikes one hit, and hits of one time keep their order") {
  Loop loop;
  for (int i = 0; i < 3; ++i) loop.push(i, 20);
  for (int ms = 0; ms < 3; ++ms) CHECK(loop.tick(ms, 0) == 1);
  CHECK(loop.struck == std::vector<std::int64_t>{0, 1, 2});
}

TEST_CASE("Overdue hits are dropped by the policy and take no time of the tick") {
  Loop loop;
  for (int i = 0; i < 100; ++i) loop.push(i, 0);
  // Two per tick, up to 30 ms late: in 31 ticks. The others are dropped at once.
  for (int ms = 0; ms < 40; ++ms) loop.tick(ms, 2);
  CHECK(loop.struck.size() == 62);
  CHECK(loop.dropped.size() == 38);
  CHECK(loop.inbox.front(sync::SimTime::max()) == nullptr);
}

TEST_CASE("Begin and end events are taken without a strike") {
  Loop loop;
  loop.push(1, 0, contact_event_t::BEGIN);
  loop.push(2, 1);
  loop.push(3, 2, contact_event_t::END);
  CHECK(loop.tick(0, 5) == 1);
  CHECK(loop.struck == std::vector<std::int64_t>{2});
  CHECK(loop.inbox.front(sync::SimTime::max()) == nullptr);
}
