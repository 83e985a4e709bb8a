#include "audio_node/mixer/scheduler.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus;
using audio::Scheduler;
using audio::Strike;

TEST_CASE("Strikes leave the scheduler in the order of their times") {
  Scheduler scheduler(300);
  std::mt19937 random(3);
  std::vector<std::pair<std::int64_t, std::int64_t>> expected;
  for (int id = 0; id < 300; ++id) {
    Strike s;
    s.event_id = id;
    s.scheduled = sync::host_time(static_cast<std::int64_t>(random() % 50));
    REQUIRE(scheduler.push(s));
    expected.emplace_back(sync::to_ns(s.scheduled), id);
  }
  SECTION("strikes of equal time keep their order of arrival") {
    std::sort(expected.begin(), expected.end());
    for (const auto& [time, id] : expected) {
      const Strike* s = scheduler.pop_before(sync::host_time(1000));
      REQUIRE(s);
      CHECK(s->event_id == id);
    }
    CHECK(scheduler.pop_before(sync::host_time(1000)) == nullptr);
  }
  SECTION("a full scheduler rejects a strike until another one has left") {
    CHECK_FALSE(scheduler.push(Strike{}));
    REQUIRE(scheduler.pop_before(sync::host_time(1000)));
    CHECK(scheduler.push(Strike{}));
  }
  SECTION("no strike leaves before its time") {
    while (const Strike* s = scheduler.pop_before(sync::host_time(25))) CHECK(s->scheduled < sync::host_time(25));
    CHECK(scheduler.size() ==
          std::count_if(expected.begin(), expected.end(), [](const auto& e) { return e.first >= 25; }));
  }
}
