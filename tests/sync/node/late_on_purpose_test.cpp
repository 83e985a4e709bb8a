// Tests of presentation deadlines for a modality with a commanded delay.
#include <catch2/catch.hpp>
#include <tactus/decision_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/playout_t.hpp>

#include "sync/presentation/presentation_matcher.h"
#include "tests/sync/presentation/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

TEST_CASE("An event with a deliberate delay is not lost before the delay has passed") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 9000);
  f.healths("visual_node", "visual", kBoth, 0, 9000);
  f.event(1, 1000);
  f.presented("visual_node", "visual", 1, 1020);
  const bool by_policy = GENERATE(true, false);
  if (by_policy) {
    playout_t m{};
    m.header = MatcherFixture::health_message("sync_node", "", 0, -70'000).header;
    m.entries = {{"audio", 3'000'000'000, 0, -1}};
    m.count = 1;
    f.matcher.observe(m, f.at(-70'000));
    for (double ms = -70'000; ms < 1000; ms += 500) f.matcher.advance(f.at(ms));  // a minute to slew to the delay
  }
  if (!by_policy) {
    degraded_t m{};
    m.header = MatcherFixture::health_message("audio_node", "audio", 0, 1010).header;
    m.modality = "audio";
    decision_t d{};
    d.key = 1, d.is_event = 1, d.held_ns = 3'000'000'000;
    m.decisions = {d};
    m.count = 1;
    f.matcher.observe(m, f.at(1010));
  }
  f.matcher.advance(f.at(3400));
  CHECK(f.tally("audio").expected == 0);
  SECTION("an event that is presented after the delay has an asynchrony") {
    f.presented("audio_node", "audio", 1, 4010);
    f.matcher.advance(f.at(5100));
    CHECK(f.tally("audio").presented == 1);
    CHECK(f.tally("audio").lost == 0);
    CHECK(f.matcher.pairs().at({"audio", "visual"}).count() == 1);
  }
  SECTION("an event that is never reported is lost after the delay") {
    f.matcher.advance(f.at(4900));
    CHECK(f.tally("audio").expected == 0);  // 1 s and 3 s have not passed
    f.matcher.advance(f.at(5100));
    CHECK(f.tally("audio").lost == 1);
  }
  SECTION("an event is not expected if the log ends before its time") {
    f.matcher.finish(f.at(3500));
    CHECK(f.tally("audio").expected == 0);
    CHECK(f.tally("visual").presented == 1);
  }
  CHECK(f.tally("visual").lost == 0);
}

TEST_CASE("After a long delay is removed, events are settled after the usual time again") {
  MatcherFixture f;
  const auto publish = [&](double ms, double delay_ms) {
    playout_t m{};
    m.header = MatcherFixture::health_message("sync_node", "", 0, ms).header;
    m.entries = {{"audio", static_cast<std::int64_t>(delay_ms * 1e6), 0, -1}};
    m.count = 1;
    f.matcher.observe(m, f.at(ms));
  };
  const auto pass = [&](double from, double to) {
    for (double ms = from; ms < to; ms += 100) f.matcher.advance(f.at(ms));
  };
  f.healths("audio_node", "audio", kHit, 0, 300'000);
  publish(0, 20'000);
  pass(0, 10'000);  // the report covers half a second by now
  publish(10'000, 0);
  pass(10'000, 25'000);
  f.event(1, 25'000);
  f.matcher.advance(f.at(26'100));
  CHECK(f.tally("audio").expected == 1);
}
