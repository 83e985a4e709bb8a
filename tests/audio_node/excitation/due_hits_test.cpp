#include "audio_node/excitation/due_hits.h"

#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>
#include <vector>

using namespace tactus;
using namespace tactus::audio;

namespace {

constexpr sync::Nanoseconds kMs{1'000'000};
const sync::LatePolicy kLate{sync::Late::kPlayWithFade, sync::Nanoseconds(50'000), 30 * kMs};

sync::HostTime at_ms(int ms) { return sync::host_time(1'000'000'000) + ms * kMs; }

// A loop of ticks of 1 ms, each with time for some hits.
struct Loop {
  DueHits due;
  std::vector<std::int64_t> sounded, dropped;
  std::vector<sync::HostTime> for_when;

  void push(std::int64_t id, int due_ms) {
    contact_event_t e{};
    e.event_id = id;
    due.push(e, at_ms(due_ms));
  }
  void tick(int ms, int time_for) {
    due.process(
        at_ms(ms), kLate, [&] { return --time_for > 0; },
        [&](const contact_event_t& e, sync::HostTime t) { sounded.push_back(e.event_id), for_when.push_back(t); },
        [&](const contact_event_t& e, sync::HostTime) { dropped.push_back(e.event_id); });
  }
};

}  // namespace

TEST_CASE("Hits that exceed the time of a tick are processed in the next ticks, earliest first") {
  Loop loop;
  for (int i = 0; i < 10; ++i) loop.push(i, 20 - i);
  loop.tick(0, 3);
  CHECK(loop.sounded == std::vector<std::int64_t>{9, 8, 7});
  CHECK(loop.due.size() == 7);
  for (int ms = 1; ms < 4; ++ms) loop.tick(ms, 3);
  CHECK(loop.sounded == std::vector<std::int64_t>{9, 8, 7, 6, 5, 4, 3, 2, 1, 0});
  CHECK(loop.for_when.back() == at_ms(20));
  CHECK(loop.dropped.empty());
}

TEST_CASE("A tick without time processes one hit, and hits of equal time keep their order") {
  Loop loop;
  for (int i = 0; i < 3; ++i) loop.push(i, 20);
  for (int ms = 0; ms < 3; ++ms) loop.tick(ms, 0);
  CHECK(loop.sounded == std::vector<std::int64_t>{0, 1, 2});
}

TEST_CASE("A waiting hit that the late policy drops is reported as dropped and takes no time") {
  Loop loop;
  for (int i = 0; i < 100; ++i) loop.push(i, 0);
  // Two per tick, up to 30 ms late: in 31 ticks. The others are dropped at once.
  for (int ms = 0; ms < 40; ++ms) loop.tick(ms, 2);
  CHECK(loop.sounded.size() == 62);
  CHECK(loop.dropped.size() == 38);
  CHECK(loop.due.size() == 0);

  SECTION("hits of an ended scene are reported as dropped") {
    loop.push(200, 100);
    std::vector<std::int64_t> over;
    loop.due.clear([&](const contact_event_t& e, sync::HostTime) { over.push_back(e.event_id); });
    CHECK(over == std::vector<std::int64_t>{200});
    CHECK(loop.due.size() == 0);
  }
}

TEST_CASE("A full queue of hits rejects further hits") {
  DueHits due;
  for (std::size_t i = 0; i < DueHits::kMax; ++i) REQUIRE(due.push({}, at_ms(0)));
  CHECK_FALSE(due.push({}, at_ms(0)));
  CHECK(due.size() == DueHits::kMax);
  due.process(
      at_ms(0), kLate, [] { return false; }, [](const auto&, auto) {}, [](const auto&, auto) {});
  CHECK(due.push({}, at_ms(0)));
}
