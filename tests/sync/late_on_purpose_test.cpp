#include <catch2/catch.hpp>

#include "sync/presentation_matcher.h"
#include "tests/sync/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

namespace {
constexpr int kHit = node_health_t::OWES_HIT;
constexpr int kBoth = int{node_health_t::OWES_BEGIN} | int{node_health_t::OWES_HIT};
}  // namespace

TEST_CASE("A sense that is late on purpose is not called lost before it could present") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 9000);
  f.healths("visual_node", "visual", kBoth, 0, 9000);
  f.event(1, 1000);
  f.presented("visual_node", "visual", 1, 1020);
  const bool by_policy = GENERATE(true, false);
  if (by_policy) {
    playout_t m{};
    m.header = MatcherFixture::health_message("sync_node", "", 0, 900).header;
    m.entries = {{"audio", 3'000'000'000, 0, -1}};
    m.count = 1;
    f.matcher.observe(m, f.at(900));
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
  CHECK(f.tally("audio").owed == 0);
  SECTION("it presents, and there is an asynchrony") {
    f.presented("audio_node", "audio", 1, 4010);
    f.matcher.advance(f.at(5100));
    CHECK(f.tally("audio").presented == 1);
    CHECK(f.tally("audio").lost == 0);
    CHECK(f.matcher.late_reports() == 0);
    CHECK(f.matcher.pairs().at({"audio", "visual"}).count() == 1);
  }
  SECTION("it says nothing, and is lost all the same") {
    f.matcher.advance(f.at(4900));
    CHECK(f.tally("audio").owed == 0);  // 1 s and 3 s have not passed
    f.matcher.advance(f.at(5100));
    CHECK(f.tally("audio").lost == 1);
  }
  SECTION("the log ends before its time, and it owes nothing") {
    f.matcher.finish(f.at(3500));
    CHECK(f.tally("audio").owed == 0);
    CHECK(f.tally("visual").presented == 1);
  }
  CHECK(f.tally("visual").lost == 0);
}
