// Tests of outcomes under long delays: those of a modality itself, of its playout, and of a world that is replaced meanwhile.
#include <catch2/catch.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>

#include "sync/random/keyed_random.h"
#include "tests/sync/presentation/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

// audio_node presents the event `delay_ms` after it happened, as it had scheduled.
void present(MatcherFixture& f, std::int64_t id, double event_ms, double delay_ms) {
  presented_t m = MatcherFixture::presented_message("audio_node", "audio", id, event_ms + delay_ms);
  m.reports[0].scheduled_ns = to_ns(MatcherFixture::at(event_ms + delay_ms));
  f.matcher.observe(m, MatcherFixture::at(event_ms + delay_ms + 1));
}

}  // namespace

TEST_CASE("An event that is due after the end of the run is not lost, for any delay of the modality itself") {
  for (std::uint64_t draw = 0; draw < 200; ++draw) {
    const double delay_ms = 1 + 4000 * uniform(7, 2 * draw), end_ms = 9000 + 1000 * uniform(7, 2 * draw + 1);
    MatcherFixture f;
    f.healths("audio_node", "audio", kHit, 0, end_ms);
    f.healths("sim_node", "", 0, 0, end_ms);
    int due = 0;
    for (int i = 0; i < 10; ++i) {
      const double ms = 1000 + 800 * i;
      f.event(i, ms);
      if (ms + delay_ms < end_ms) present(f, i, ms, delay_ms), ++due;
      f.matcher.advance(f.at(ms + 1));
    }
    f.matcher.finish(f.at(end_ms));
    CHECK(f.tally("audio").presented == due);
    CHECK(f.tally("audio").lost == 0);
  }
}

TEST_CASE("An event that was due and has no report is lost, also with a long delay") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 5000);
  f.event(1, 1000);
  present(f, 1, 1000, 500);
  f.event(2, 3000);
  f.matcher.finish(f.at(5000));
  CHECK(f.tally("audio").presented == 1);
  CHECK(f.tally("audio").lost == 1);
}

TEST_CASE("An event that is due after its world was replaced counts as dead, and one that was due before as lost") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 6000);
  f.healths("sim_node", "", 0, 0, 3200, 100);
  f.event(1, 1000);
  present(f, 1, 1000, 500);
  f.event(2, 2000);
  f.event(3, 3000);
  f.healths("sim_node", "", 0, 3400, 6000, 101);
  f.matcher.advance(f.at(6000));
  CHECK(f.tally("audio").presented == 1);
  CHECK(f.tally("audio").lost == 1);
  CHECK(f.tally("audio").dead == 1);
}

TEST_CASE("Events of a modality whose output could never be opened count as dead") {
  MatcherFixture f;
  f.health("audio_node", "audio", kHit, 0, 1, node_health_t::WAITING);
  f.healths("audio_node", "audio", kHit, 100, 4000, 1, node_health_t::OUTPUT_LOST);
  f.event(1, 1000);
  f.event(2, 2000);
  f.matcher.advance(f.at(4000));
  CHECK(f.tally("audio").expected == 2);
  CHECK(f.tally("audio").dead == 2);
}
