// Tests of the warnings of a run: late processes, lost outputs and silence.
#include "sync/tools/summary/run_warnings.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/world_state_t.hpp>

#include "tests/sync/tools/summary/summary_fixture.h"

using namespace tactus;
using namespace tactus::sync;
using Catch::Contains;

namespace {

void world(RunLog& log, int from_ms, int to_ms, std::int64_t first_sim_ms = 0) {
  for (int ms = from_ms; ms <= to_ms; ms += 20) {
    world_state_t m{};
    m.header = header_of("sim_node", 100, 0, to_ns(MatcherFixture::at(ms)));
    m.header.sim_time_ns = (first_sim_ms + ms - from_ms) * 1'000'000;
    m.pages = 1;
    log.send(channels::kWorldState, m, ms);
  }
}

void healths(RunLog& log, int from_ms, int to_ms, std::int8_t state) {
  for (int ms = from_ms; ms <= to_ms; ms += 100) log.health("audio_node", "audio", ms, 750, 1, state);
}

void hits(RunLog& log, int count) {
  for (int i = 0; i < count; ++i)
    log.send(channels::kContactEvents, MatcherFixture::event_message(i, 1100 + 100 * i, contact_event_t::HIT, 100), 1101 + 100 * i);
}

std::vector<std::string> warnings(const RunLog& log) { return log.summary().warnings(); }

}  // namespace

TEST_CASE("An ordinary run has no warnings of its own") {
  RunLog log;
  ordinary_run(log);
  CHECK(warnings(log).empty());
}

TEST_CASE("A process that has no scene when the world begins is named, with its reason") {
  RunLog log;
  log.status_text = "prepares the pictures of the scene; normal scheduling";
  healths(log, 0, 1400, node_health_t::WAITING);
  world(log, 1000, 4000);
  healths(log, 1500, 4000, node_health_t::RUNNING);
  REQUIRE(warnings(log).size() == 1);
  CHECK(warnings(log)[0] == "audio_node was not ready when the world began (prepares the pictures of the scene); it missed the first events");
  CHECK_THAT(to_text(log.summary()), Contains("was not ready when the world began"));
  CHECK_THAT(to_json(log.summary()), Contains("was not ready when the world began"));
}

TEST_CASE("A process that starts after the world is named, unless the log begins midway") {
  for (const bool midway : {false, true}) {
    RunLog log;
    world(log, 0, 1000, midway ? 5000 : 0);
    healths(log, 1000, 4000, node_health_t::RUNNING);
    world(log, 1020, 4000, 1020);
    CHECK(warnings(log).size() == (midway ? 0u : 1u));
  }
}

TEST_CASE("The ticks that a node misses in each of the first seconds of the world are counted apart from those before and after") {
  RunLog log;
  std::int64_t missed = 0;
  for (int ms = 0; ms <= 8000; ms += 100) {
    if (ms >= 3000) world(log, ms, ms + 80, ms - 3000);
    // 40 while it prepares, 2 in the first second, 7 in the second one, 0 in the third, 5 later.
    missed += ms == 1000 ? 40 : ms == 3500 ? 2 : ms == 4500 ? 7 : ms == 7000 ? 5 : 0;
    log.health("visual_node", "visual", ms, 60, 1, ms < 2800 ? node_health_t::WAITING : node_health_t::RUNNING, missed);
  }
  const NodeSummary n = log.summary().nodes().at("visual_node");
  CHECK(n.missed_ticks == 54);
  CHECK(n.missed_by_second == std::vector<std::int64_t>{2, 7, 0});
  CHECK_THAT(to_text(log.summary()), Contains("2 of the missed in the first second of the world, 7 in the second, 0 in the third"));
  CHECK_THAT(to_json(log.summary()), Contains("\"missed_first_second\": 2"));
  RunLog midway;
  for (int ms = 0; ms <= 2000; ms += 100) {
    world(midway, ms, ms + 80, 5000 + ms);
    midway.health("visual_node", "visual", ms, 60, 1, node_health_t::RUNNING, ms);
  }
  CHECK(midway.summary().nodes().at("visual_node").missed_by_second.empty());
}

TEST_CASE("A log that ends early, and a node that starts again, have the missed ticks of their whole seconds only") {
  RunLog log;
  for (int ms = 0; ms <= 2500; ms += 100) {
    world(log, ms, ms + 80, ms);
    log.health("visual_node", "visual", ms, 60, 1, node_health_t::RUNNING, ms / 100);
    log.health("audio_node", "audio", ms, 60, ms < 1500 ? 1 : 2, node_health_t::RUNNING, ms < 1500 ? 3 : 0);
  }
  CHECK(log.summary().nodes().at("visual_node").missed_by_second.size() == 2);
  CHECK(log.summary().nodes().at("audio_node").missed_by_second.size() == 1);
}

TEST_CASE("A silent modality is named when events happened, and is not when a profile silences it") {
  for (const bool has_scene : {false, true}) {
    RunLog log;
    healths(log, 0, 1000, has_scene ? node_health_t::READY : node_health_t::WAITING);
    world(log, 1000, 4000);
    hits(log, 5);
    healths(log, 1100, 4000, has_scene ? node_health_t::RUNNING : node_health_t::WAITING);
    const std::vector<std::string> found = warnings(log);
    REQUIRE_FALSE(found.empty());
    CHECK_THAT(found.back(), Contains("audio presented none of the 5 events"));
  }
  RunLog muted;
  healths(muted, 0, 1000, node_health_t::READY);
  world(muted, 1000, 4000);
  hits(muted, 5);
  for (int i = 0; i < 5; ++i)
    muted.send(channels::kPresented,
               MatcherFixture::presented_message("audio_node", "audio", i, 1110 + 100 * i, presentation_t::DROPPED_BY_PROFILE), 1111 + 100 * i);
  healths(muted, 1100, 4000, node_health_t::RUNNING);
  CHECK(warnings(muted).empty());
}

TEST_CASE("An output that cannot be opened is a warning, and its events are counted as dead") {
  RunLog log;
  log.status_text = "there is no sound card \"x\"; normal scheduling";
  healths(log, 0, 900, node_health_t::OUTPUT_LOST);
  for (int ms = 1000; ms <= 4000; ms += 100) {
    world(log, ms, ms + 80, ms - 1000);
    healths(log, ms, ms, node_health_t::OUTPUT_LOST);
    if (ms == 1500) hits(log, 5);
  }
  const RunSummary s = log.summary();
  CHECK(s.matcher().modalities().at("audio").dead == 5);
  CHECK_THAT(s.warnings().at(0), Contains("audio_node had no output in") && Contains("there is no sound card"));
  CHECK_THAT(s.warnings().at(1), Contains("presented none of the 5"));
}
