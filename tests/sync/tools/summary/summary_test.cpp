// Tests of the summary of a run.
#include "sync/tools/summary/summary.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/world_state_t.hpp>

#include "tests/sync/tools/summary/summary_fixture.h"

using namespace tactus;
using namespace tactus::sync;
using Json = nlohmann::json;

TEST_CASE("The summary of a run has all documented fields") {
  RunLog log;
  ordinary_run(log);
  const RunSummary s = log.summary({.scene = {},
                                    .git = {},
                                    .seconds = {},
                                    .seed = {},
                                    .nodes = {"audio_node"},
                                    .restarts = {},
                                    .warnings = {}});
  CHECK(s.failure().empty());
  const Json j = Json::parse(to_json(s));
  CHECK(j["scene"] == "room.sdf");
  CHECK(j["seconds"] == 10);
  CHECK(j["seed"] == 42);
  CHECK(j["git"] == "abc");
  CHECK(j["realtime_factor"] == Approx(0.99));
  CHECK(j["nodes"]["audio_node"]["rate_hz"].get<double>() == Approx(750));
  CHECK(j["nodes"]["audio_node"]["ticks"] == 7500);
  CHECK(j["nodes"]["audio_node"]["stale_ticks"] == 4);
  CHECK(j["nodes"]["audio_node"]["restarts"] == 0);
  CHECK(j["nodes"]["audio_node"]["scheduling"] == "SCHED_FIFO 60, memory locked");
  for (const char* q : {"p50", "p99", "p999", "max"}) {
    CHECK(j["nodes"]["audio_node"]["tick_us"].contains(q));
    CHECK(j["nodes"]["audio_node"]["wake_us"].contains(q));
  }
  CHECK(j["contacts"]["hit"] == 80);
  CHECK(j["contacts"]["begin"] == 0);
  CHECK(j["contacts"]["end"] == 0);
  CHECK(j["contacts"]["presented"] == Json({{"haptic", 0}, {"audio", 80}, {"visual", 80}, {"thermal", 0}}));
  for (const char* outcome : {"lost", "stalled", "dropped_by_profile"}) CHECK(j["contacts"][outcome] == 0);
  CHECK(j["asynchrony_ms"]["audio_visual"]["n"] == 80);
  CHECK(j["asynchrony_ms"]["audio_visual"]["p50"].get<double>() == Approx(-7).margin(0.1));
  CHECK(j["asynchrony_ms"]["haptic_audio"] ==
        Json({{"n", 0}, {"p05", nullptr}, {"p50", nullptr}, {"p95", nullptr}, {"uncertainty", nullptr},
                                                    {"beyond_least_threshold", nullptr}, {"beyond_all_thresholds", nullptr}}));
  CHECK(j["asynchrony_ms"].contains("haptic_visual"));
  CHECK(j["bus"]["WORLD_STATE"]["messages"] == 501);
  CHECK(j["bus"]["WORLD_STATE"]["gaps"] == 0);
  CHECK_FALSE(j["bus"].contains("LOG_INFO"));  // did not cross the bus
  CHECK_THAT(to_text(s), Catch::Contains("audio to visual"));
}

TEST_CASE("The summary has the last state of the game, or null without a game") {
  const SummaryOptions as_logged;
  RunLog log;
  ordinary_run(log);
  CHECK(Json::parse(to_json(log.summary(as_logged)))["game"].is_null());
  game_state_t m{};
  m.header = header_of("sim_node", 1, 0, MatcherFixture::kBase);
  m.won_ns = -1;
  m.holes.resize(2);
  m.holes[0].name = "a", m.holes[1].name = "b";
  m.holes[0].filled = 1;
  m.count = 2;
  log.send(channels::kGameState, m, 9000);
  const RunSummary half = log.summary(as_logged);
  CHECK(Json::parse(to_json(half))["game"] == Json({{"holes", 2}, {"filled", 1}, {"won_at_s", nullptr}}));
  CHECK_THAT(to_text(half), Catch::Contains("game: 1 of 2 holes filled"));
  m.holes[1].filled = m.won = 1;
  m.won_ns = 7'250'000'000;
  log.send(channels::kGameState, m, 9100);
  const RunSummary won = log.summary(as_logged);
  CHECK(Json::parse(to_json(won))["game"] == Json({{"holes", 2}, {"filled", 2}, {"won_at_s", 7.25}}));
  CHECK_THAT(to_text(won), Catch::Contains("all 2 holes filled, at 7.25 s"));
}

TEST_CASE("Options of the caller override the values in the log") {
  RunLog log;
  ordinary_run(log);
  const RunSummary s = log.summary({.scene = "other.sdf",
                                    .git = "def",
                                    .seconds = 20,
                                    .seed = 1,
                                    .nodes = {},
                                    .restarts = {{"audio_node", 4}},
                                    .warnings = {}});
  const Json j = Json::parse(to_json(s));
  CHECK(j["scene"] == "other.sdf");
  CHECK(j["git"] == "def");
  CHECK(j["seconds"] == 20);
  CHECK(j["seed"] == 1);
  CHECK(j["nodes"]["audio_node"]["restarts"] == 4);
}

TEST_CASE("Modalities without a node are absent") {
  RunLog log;
  ordinary_run(log);
  const RunSummary s = log.summary();
  CHECK(Json::parse(to_json(s))["absent"] == Json({"haptic", "thermal"}));
  CHECK_THAT(to_text(s), Catch::Contains("absent: haptic, thermal\n"));
}

TEST_CASE("Warnings of the run are part of the summary") {
  RunLog log;
  ordinary_run(log);
  SummaryOptions options;
  options.warnings = {"visual_node: no ffmpeg"};
  const RunSummary s = log.summary(options);
  CHECK(Json::parse(to_json(s))["warnings"] == Json({"visual_node: no ffmpeg"}));
  CHECK_THAT(to_text(s), Catch::Contains("\nvisual_node: no ffmpeg\n"));
}

TEST_CASE("Late events count as presented and also as late") {
  RunLog log;
  ordinary_run(log);
  log.send(channels::kContactEvents, MatcherFixture::event_message(1, 8101, contact_event_t::HIT, 100), 10001);
  log.send(channels::kPresented,
           MatcherFixture::presented_message("audio_node", "audio", 1, 8400, presentation_t::LATE), 10002);
  for (int ms = 10100; ms < 12000; ms += 100) log.health("audio_node", "audio", ms, 750);
  const Json contacts = Json::parse(to_json(log.summary()))["contacts"];
  CHECK(contacts["late"] == 1);
  CHECK(contacts["by_modality"]["audio"]["late"] == 1);
  CHECK(contacts["by_modality"]["audio"]["presented"] == 81);
}

TEST_CASE("The summary uses the last note of a node before the simulation ended") {
  RunLog log;
  for (int ms = 0; ms <= 4000; ms += 100) {
    if (ms == 3000) log.status_text = "input lost";
    log.health("haptic_node", "haptic", ms, 1000);
    world_state_t world{};
    world.header = header_of("sim_node", 100, 0, to_ns(MatcherFixture::at(ms)));
    world.header.sim_time_ns = std::int64_t{ms} * 1'000'000;
    world.pages = 1;
    if (ms < 3000) log.send(channels::kWorldState, world, ms);
    if (ms < 3000) log.health("sim_node", "", ms, 1000, 100);
  }
  CHECK(log.summary().nodes().at("haptic_node").scheduling == "SCHED_FIFO 60, memory locked");
}

TEST_CASE("The summary contains the effect of the profile that a node measured") {
  RunLog log;
  log.status_text = "SCHED_FIFO 60, memory locked; profile effect: events +40.0 ms (sd 3.0)";
  ordinary_run(log);
  CHECK(log.summary().nodes().at("audio_node").scheduling == "SCHED_FIFO 60, memory locked");
  CHECK_THAT(to_text(log.summary()), Catch::Contains("  profile effect: events +40.0 ms (sd 3.0)\n"));
  CHECK_THAT(to_json(log.summary()), Catch::Contains("profile_effect"));
}

TEST_CASE("Control characters are escaped in the text of a summary") {
  RunLog log;
  log.status_text = "a\x1b[2Jb\nc";
  ordinary_run(log);
  const std::string text = to_text(log.summary());
  CHECK(text.find('\x1b') == std::string::npos);
  CHECK_THAT(text, Catch::Contains("a\\x1b[2Jb\\x0ac"));
}

TEST_CASE("The figures of all incarnations of a node are added") {
  RunLog log;
  for (int ms = 0; ms <= 4000; ms += 100)
    log.health("audio_node", "audio", ms, 1000, 1, node_health_t::RUNNING, 5);
  for (int ms = 4200; ms <= 5000; ms += 100) log.health("audio_node", "audio", ms, 100, 2, node_health_t::WAITING);
  for (int ms = 5100; ms <= 9000; ms += 100)
    log.health("audio_node", "audio", ms, 1000, 2, node_health_t::RUNNING, 7);
  const auto nodes = log.summary().nodes();
  const NodeSummary& n = nodes.at("audio_node");
  CHECK(n.restarts == 1);
  CHECK(n.missed_ticks == 12);
  CHECK(n.rate_Hz == Approx(1000));  // the wait at another rate is not counted
  CHECK(n.tick.count() == 2);
  CHECK(n.tick.max() == Nanoseconds(200'000));
  CHECK(n.alive_at_end);
}

TEST_CASE("The failure of a run names lost events and missing nodes") {
  RunLog log;
  ordinary_run(log);
  log.send(channels::kContactEvents, MatcherFixture::event_message(1, 8100, contact_event_t::HIT, 100), 10001);
  for (int ms = 10100; ms < 14000; ms += 100) log.health("visual_node", "visual", ms, 60);
  const SummaryOptions options{.scene = {},
                               .git = {},
                               .seconds = {},
                               .seed = {},
                               .nodes = {"audio_node", "visual_node", "haptic_node"},
                               .restarts = {},
                               .warnings = {}};
  const std::string why = log.summary(options).failure();
  CHECK_THAT(why, Catch::Contains("haptic_node never reported"));
  CHECK_THAT(why, Catch::Contains("audio_node was not alive at the end"));
  CHECK_THAT(why, Catch::Contains("visual lost 1 of 81 expected contact events"));
  CHECK_THAT(why, Catch::Contains("audio lost 1 of 81 expected contact events"));
}

TEST_CASE("Missing messages count as gaps and undecodable ones as bad") {
  RunLog log;
  for (int ms = 0; ms <= 1000; ms += 100) {
    if (ms == 500) log.seq["NODE_HEALTH" + std::to_string(static_cast<std::int32_t>(fnv1a_32("a")))] += 3;
    log.health("a", "", ms, 10);
  }
  log.writer.write((to_ns(MatcherFixture::at(1001)) + kOffsetNs) / 1000, channels::kNodeHealth, std::vector<std::uint8_t>(20, 1));
  log.writer.flush();
  const auto bus = log.summary().channels();
  CHECK(bus.at("NODE_HEALTH").gaps == 3);
  CHECK(bus.at("NODE_HEALTH").bad == 1);
  CHECK(bus.at("NODE_HEALTH").messages == 12);
  CHECK(Json::parse(to_json(log.summary()))["damage"] == Json({"1 of 12 messages of NODE_HEALTH are incomplete or damaged and are left out"}));
}

TEST_CASE("A damaged log is summarised from its intact messages") {
  RunLog log;
  ordinary_run(log);
  auto& bytes = log.state->bytes;
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2),
            bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2 + 300), std::uint8_t{0xff});
  const RunSummary s = log.summary();
  CHECK(s.damaged_regions() >= 1);
  CHECK(s.matcher().hits() >= 79);
  CHECK(s.nodes().at("visual_node").alive_at_end);

  SECTION("a damaged time stamp does not end the run") {
    LogScanner scanner(log.state->bytes);
    RunSummary jumped({});
    int n = 0;
    for (LogEvent e; scanner.next(e);) {
      if (++n == 700) e.timestamp_us += 1'000'000'000'000;
      jumped.add(e);
    }
    jumped.end_of_log(1);
    CHECK(jumped.failure() == s.failure());
    CHECK(jumped.recorded_seconds() == Approx(10.0));
  }
}

TEST_CASE("An empty log and a log without its head can be summarised") {
  RunSummary empty({});
  empty.end_of_log(0);
  CHECK(Json::parse(to_json(empty))["seconds"] == 0);
  CHECK(empty.failure().empty());

  RunLog log(false);
  ordinary_run(log);
  const RunSummary s = log.summary();
  CHECK(s.failure().empty());
  CHECK(s.matcher().modalities().at("audio").presented == 80);
  CHECK(s.seconds() == Approx(10.0));
}

TEST_CASE("The logs of a restarted recorder are summarised as one run") {
  RunLog whole;
  ordinary_run(whole);
  RunSummary s({});
  for (int i = 0; i < 2; ++i) {
    LogScanner scanner(whole.state->bytes);
    for (LogEvent e; scanner.next(e);) s.add(e);
    s.end_of_log(0);
  }
  // The same events again, within a run: no modality must present an event twice.
  CHECK(s.matcher().hits() <= 160);
  CHECK(s.failure().empty());
  CHECK(s.recorded_seconds() == Approx(20.0));
}

TEST_CASE("A LOG_INFO message from a replay does not change the time base") {
  RunLog log;
  log_info_t other{};
  other.header = header_of("recorder", 99, 0, 5, 3);
  other.scene = "other.sdf";
  other.realtime_offset_ns = 1;
  other.live_from_ns = std::numeric_limits<std::int64_t>::max();
  log.write(channels::kLogInfo, other, 0);
  ordinary_run(log);
  const RunSummary s = log.summary();
  CHECK(s.scene() == "room.sdf");
  CHECK(s.matcher().hits() == 80);
}

TEST_CASE("Presentation times of another host are mapped by the clock maps in the log, with their uncertainty") {
  constexpr std::int64_t kAhead = 3'600'000'000'000;
  const bool mapped = GENERATE(true, false);
  RunLog log;
  const auto there = [&](auto m) {
    m.header.clock = 2;
    m.header.publish_time_ns += kAhead;
    return m;
  };
  for (int ms = 0; ms <= 6000; ms += 100) {
    log.health("visual_node", "visual", ms, 60);
    log.send(channels::kNodeHealth,
             there(MatcherFixture::health_message("audio_node", "audio", node_health_t::EXPECTS_HIT, ms)), ms);
    if (mapped && ms % 500 == 0) {
      clock_map_t map{};
      map.header = header_of("sync_node", 1, 0, to_ns(MatcherFixture::at(ms)));
      map.of_clock = 2, map.at_ns = map.header.publish_time_ns, map.offset_ns = kAhead,
      map.uncertainty_ns = 120'000;
      log.send(channels::kClockMap, map, ms);
    }
    if (ms < 1000 || ms > 4000) continue;
    log.send(channels::kContactEvents, MatcherFixture::event_message(ms, ms - 1, contact_event_t::HIT, 100), ms);
    log.send(channels::kPresented, MatcherFixture::presented_message("visual_node", "visual", ms, ms + 12),
             ms + 2);
    presented_t heard = there(MatcherFixture::presented_message("audio_node", "audio", ms, ms + 19));
    heard.header.publish_time_ns = to_ns(MatcherFixture::at(ms)) + kAhead;
    heard.reports[0].presented_ns += kAhead;
    heard.reports[0].uncertainty_ns = 30'000;
    log.send(channels::kPresented, heard, ms + 1);
  }
  const Json j = Json::parse(to_json(log.summary()));
  CHECK(j["contacts"]["by_modality"]["audio"]["presented"] == 31);
  CHECK(j["contacts"]["lost"] == 0);
  const Json& pair = j["asynchrony_ms"]["audio_visual"];
  if (mapped) {
    CHECK(pair["n"] == 31);
    CHECK(pair["p50"].get<double>() == Approx(-7).margin(0.1));
    CHECK(pair["uncertainty"].get<double>() == Approx(0.16));  // 120 and 30 us, rounded up
  } else {
    CHECK(pair["n"] == 0);
    CHECK(pair["uncertainty"].is_null());
  }
}
TEST_CASE("A stopped recorder leaves a hole in the log, which fails the run") {
  RunLog log;
  const auto speak = [&](int from_ms, int to_ms) {
    for (int ms = from_ms; ms <= to_ms; ms += 100) log.health("audio_node", "audio", ms, 750);
  };
  speak(0, 2000);
  SECTION("sequence numbers are missing after the pause") {
    for (auto& [sender, next] : log.seq) next += 30;
    speak(5000, 8000);
    const RunSummary s = log.summary();
    CHECK(s.holes_seconds() == Approx(3));
    CHECK_THAT(s.failure(), Catch::Contains("the log has a hole of 3 s"));
    CHECK_THAT(to_text(s), Catch::Contains("the log has a hole of 3.0 s"));
    CHECK(Json::parse(to_json(s))["log_holes_seconds"] == Approx(3));
  }
  SECTION("the kernel buffered the first messages after the pause") {
    speak(5000, 6500);
    for (auto& [sender, next] : log.seq) next += 30;
    speak(6600, 8000);
    CHECK(log.summary().holes_seconds() == Approx(3));
  }
  SECTION("a silence of the nodes is not a hole") {
    speak(5000, 8000);
    CHECK(log.summary().holes_seconds() == 0);
    CHECK(log.summary().failure().empty());
  }
  SECTION("a loss without a pause is not a hole") {
    for (auto& [sender, next] : log.seq) next += 30;
    speak(2100, 5000);
    CHECK(log.summary().holes_seconds() == 0);
  }
}

TEST_CASE("A run with too many events to match is reported as a failure") {
  RunLog log;
  ordinary_run(log);
  for (int i = 0; i < static_cast<int>(PresentationMatcher::kMaxEvents) + 10; ++i)
    log.send(channels::kContactEvents,
             MatcherFixture::event_message(1'000'000 + i, 9900, contact_event_t::END, 100), 9901);
  log.health("audio_node", "audio", 10'100, 750);
  const RunSummary s = log.summary();
  CHECK_THAT(s.failure(), Catch::Contains("exceed the limits of the matching"));
  CHECK_THAT(to_text(s), Catch::Contains("exceed the limits of the matching"));
}

TEST_CASE("The summary has the share of each quality step and the age of the inputs") {
  RunLog log;
  log.qualities = 3;
  input_health_t input{};
  input.channel = "WORLD_STATE";
  for (int i = 0; i < 100; ++i) {
    log.quality = i < 75 ? 0 : 2;
    input.age_ns = i < 90 ? 5'000'000 : 80'000'000;
    log.inputs = {input};
    log.health("visual_node", "visual", 100.0 * i, 60);
  }
  const Json j = Json::parse(to_json(log.summary()))["nodes"]["visual_node"];
  CHECK(j["quality"] == Json::array({0.75, 0, 0.25}));
  // Tolerance: a bin of the histogram, a quarter octave.
  CHECK(j["input_age_ms"]["WORLD_STATE"]["p50"].get<double>() == Approx(5).epsilon(0.19));
  CHECK(j["input_age_ms"]["WORLD_STATE"]["p99"].get<double>() == Approx(80).epsilon(0.19));
}

TEST_CASE("A node without a quality ladder has no quality in the summary") {
  RunLog log;
  log.health("visual_node", "visual", 0, 60);
  CHECK(Json::parse(to_json(log.summary()))["nodes"]["visual_node"]["quality"].is_null());
}
