#include "scripts/conductor/observations.h"

#include <catch2/catch.hpp>
#include <string>

using namespace tactus;
using namespace tactus::conductor;

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
  m.picture = picture, m.chunk = chunk, m.chunks = chunks, m.size = static_cast<int>(bytes.size());
  m.data.assign(bytes.begin(), bytes.end());
  return m;
}

}  // namespace

TEST_CASE("What is repeated on the bus is said once") {
  Observations o(kOwn);
  contact_events_t events{};
  events.count = 1;
  events.events.emplace_back().event_id = 42;
  CHECK(o.push(events).size() == 1);
  CHECK(o.push(events).empty());
  CHECK(o.push(presented(42, 100), sync::host_time(200)).size() == 1);
  CHECK(o.push(presented(42, 100), sync::host_time(220)).empty());
}

TEST_CASE("A presentation is said with its instant and its uncertainty, and without when there was none") {
  Observations o(kOwn);
  const auto said = o.push(presented(1, 100), sync::host_time(200));
  CHECK(said.at(0).at("at_ns") == 100);
  CHECK(said.at(0).at("uncertainty_ns") == 4);
  CHECK(said.at(0).at("presented") == "1");
  const auto dropped = o.push(presented(2, -1), sync::host_time(200));
  CHECK(dropped.at(0).at("at_ns").is_null());
}

TEST_CASE("An event of 64 bits survives JSON, where numbers are doubles") {
  Observations o(kOwn);
  contact_events_t events{};
  events.count = 1;
  events.events.emplace_back().event_id = 5589537784101601287;
  CHECK(o.push(events).at(0).at("event") == "5589537784101601287");
}

TEST_CASE("A picture is said when all of its pieces have come, in whatever order, and not otherwise") {
  Observations o(kOwn);
  CHECK_FALSE(o.push(piece(1, 0, 2, "ab")));
  CHECK_FALSE(o.push(piece(2, 1, 2, "d")));
  const auto whole = o.push(piece(2, 0, 2, "abc"));
  REQUIRE(whole);
  CHECK(whole->at("jpeg") == "YWJjZA==");
  CHECK_FALSE(o.push(piece(1, 1, 2, "x")));
}

TEST_CASE("How a game stands is said when it changes") {
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
