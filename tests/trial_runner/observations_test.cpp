// Tests of the lines that report messages of the bus to a study.
#include "scripts/trial_runner/observations.h"

#include <catch2/catch.hpp>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/tool_state_t.hpp>

using namespace tactus;
using namespace tactus::trial_runner;

namespace {

const sync::OwnClock kOwn{1, 5, nullptr};

presented_t presented(std::int64_t event, std::int64_t at_ns) {
  presented_t m{};
  m.header.run_id = 1, m.header.clock = 5, m.header.source = 3, m.header.incarnation = 9,
  m.header.publish_time_ns = at_ns + 1;
  m.modality = "audio", m.count = 1;
  presentation_t p{};
  p.event_id = event, p.presented_ns = at_ns, p.scheduled_ns = 90, p.uncertainty_ns = 4,
  p.outcome = presentation_t::PRESENTED;
  m.reports.push_back(p);
  return m;
}

picture_chunk_t piece(std::int64_t picture, int chunk, int chunks, const std::string& bytes) {
  picture_chunk_t m{};
  m.header.run_id = 1, m.header.clock = 5, m.header.source = 3, m.header.incarnation = 9;
  m.picture = picture, m.presented_ns = 40, m.chunk = chunk, m.chunks = chunks, m.size = static_cast<int>(bytes.size());
  m.data.assign(bytes.begin(), bytes.end());
  return m;
}

}  // namespace

TEST_CASE("Messages that the bus repeats are written once") {
  Observations o(kOwn);
  contact_events_t events{};
  events.count = 1;
  events.events.emplace_back().event_id = 42;
  CHECK(o.push(events).size() == 1);
  CHECK(o.push(events).empty());
  CHECK(o.push(presented(42, 100), sync::host_time(200)).size() == 1);
  CHECK(o.push(presented(42, 100), sync::host_time(220)).empty());
}

TEST_CASE("A presentation is written with its time and uncertainty, and a dropped one without a time") {
  Observations o(kOwn);
  const auto lines = o.push(presented(1, 100), sync::host_time(200));
  CHECK(lines.at(0).at("at_ns") == 100);
  CHECK(lines.at(0).at("uncertainty_ns") == 4);
  CHECK(lines.at(0).at("presented") == "1");
  const auto dropped = o.push(presented(2, -1), sync::host_time(200));
  CHECK(dropped.at(0).at("at_ns").is_null());
}

TEST_CASE("A 64-bit event id is exact in JSON, where numbers are doubles") {
  Observations o(kOwn);
  contact_events_t events{};
  events.count = 1;
  events.events.emplace_back().event_id = 5589537784101601287;
  CHECK(o.push(events).at(0).at("event") == "5589537784101601287");
}

TEST_CASE("A picture is written when all of its chunks have arrived, in any order") {
  Observations o(kOwn);
  const std::string full(1024, 'a');
  const auto arrival = sync::host_time(100);
  CHECK_FALSE(o.push(piece(1, 0, 2, full), arrival));
  CHECK_FALSE(o.push(piece(2, 1, 2, "d"), arrival));
  const auto whole = o.push(piece(2, 0, 2, full), arrival);
  REQUIRE(whole);
  const std::string jpeg = whole->at("jpeg");
  CHECK(jpeg.size() == 1368);  // RFC 4648 of 1025 bytes
  CHECK(jpeg.substr(0, 8) == "YWFhYWFh");
  CHECK(jpeg.substr(1364) == "YWQ=");
  CHECK(whole->at("at_ns") == 40);
  CHECK_FALSE(o.push(piece(1, 1, 2, "x"), arrival));
  auto unknown = piece(3, 0, 1, "ab");
  unknown.presented_ns = -1;
  CHECK(o.push(unknown, arrival)->at("at_ns").is_null());
}

TEST_CASE("The tick in which the vibration of a hit begins is written, separately for each tool") {
  Observations o(kOwn);
  std::int64_t at_ns = 1'000'000;
  const auto tick = [&](float transient_N, int source) {
    tool_state_t m{};
    m.header.run_id = 1, m.header.clock = 5, m.header.source = source, m.header.incarnation = 9;
    m.header.publish_time_ns = at_ns += 1'000'000;
    m.tool = source, m.transient_N = {0, 0, transient_N};
    return o.push(m, sync::host_time(at_ns + 50'000));
  };
  CHECK_FALSE(tick(0, 3));
  const auto begins = tick(0.5F, 3);
  REQUIRE(begins);
  CHECK(begins->at("pulse").at("at_ns") == 3'000'000);
  CHECK(begins->at("pulse").at("force_N") == 0.5);
  CHECK_FALSE(tick(-0.4F, 3));
  CHECK(tick(0.2F, 4));
  CHECK_FALSE(tick(0, 3));
  CHECK(tick(0.1F, 3));
}

TEST_CASE("The state of a game is written when it changes") {
  Observations o(kOwn);
  game_state_t m{};
  m.won_ns = -1, m.count = 1;
  m.holes.emplace_back().inside = -1;
  CHECK(o.push(m));
  CHECK_FALSE(o.push(m));
  m.holes[0].inside = 3;
  const auto wrong = o.push(m);
  REQUIRE(wrong);
  CHECK(wrong->at("game").at("wrong") == 1);
}
