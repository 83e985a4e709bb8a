// Tests of playing a log in the live page: speed, seek, length and damage.
#include "scripts/live/log_player.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <tactus/log_info_t.hpp>

#include "lcmtypes/channels.h"
#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::live;

namespace {

constexpr std::int64_t kBegin_us = 1'700'000'000'000'000;
constexpr int kEvents = 6000;  // one per 10 ms: a minute

// A log of numbered events.
std::shared_ptr<sync::MemorySink::State> one_minute_log() {
  auto state = std::make_shared<sync::MemorySink::State>();
  sync::LogWriter writer(std::make_unique<sync::MemorySink>(state));
  for (int i = 0; i < kEvents; ++i) {
    std::uint8_t bytes[sizeof i];
    std::memcpy(bytes, &i, sizeof i);
    writer.write(kBegin_us + 10'000 * static_cast<std::int64_t>(i), "NUMBER", bytes);
  }
  writer.flush();
  return state;
}

struct PlayerFixture {
  std::shared_ptr<sync::MemorySink::State> log = one_minute_log();
  LogPlayer player{std::span<const std::uint8_t>(log->bytes)};
  std::vector<int> events;
  PlayerFixture() {
    while (player.scan_next()) {
    }
  }
  void advance(double s) {
    player.advance(sync::from_seconds(s), [&](std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime) {
      int i = -1;
      if (channel == "NUMBER" && bytes.size() == sizeof i) std::memcpy(&i, bytes.data(), sizeof i);
      events.push_back(i);
    });
  }
};

}  // namespace

TEST_CASE("A log is replayed at its own speed, each event once and in order") {
  PlayerFixture p;
  CHECK(p.player.length_s() == Approx(59.99));
  for (int i = 0; i < 200; ++i) p.advance(0.05);
  REQUIRE(p.events.size() == 1001);  // the first ten seconds, with both ends
  for (int i = 0; i < 1001; ++i) REQUIRE(p.events[static_cast<std::size_t>(i)] == i);
  CHECK(p.player.position_s() == Approx(10));

  SECTION("at eight times its speed") {
    p.player.play(true, 8);
    for (int i = 0; i < 20; ++i) p.advance(0.05);
    CHECK(p.events.size() == 1801);
  }
  SECTION("a paused log keeps its position") {
    p.player.play(false, 1);
    for (int i = 0; i < 20; ++i) p.advance(0.05);
    CHECK(p.events.size() == 1001);
    CHECK(p.player.position_s() == Approx(10));
  }
  SECTION("at its end it stops, after all events") {
    p.player.play(true, 16);
    for (int i = 0; i < 200; ++i) p.advance(0.05);
    CHECK(p.events.size() == kEvents);
    CHECK(p.player.position_s() == Approx(p.player.length_s()));
  }
}

TEST_CASE("A seek to any time stops there and first sends the events of the three seconds before it") {
  PlayerFixture p;
  p.player.play(false, 1);
  std::mt19937 random(9);
  for (int i = 0; i < 300; ++i) {
    const double to_s = static_cast<double>(random() % 60'000) / 1000;
    p.player.seek(to_s);
    p.events.clear();
    p.advance(0.05);
    REQUIRE(p.player.position_s() == Approx(std::min(to_s, p.player.length_s())));
    REQUIRE_FALSE(p.events.empty());
    const int last = static_cast<int>(std::floor(std::min(to_s, p.player.length_s()) * 100 + 1e-6));
    REQUIRE(p.events.back() == last);
    // Playback begins at an index entry, at most half a second earlier.
    const int from = last - 300;
    REQUIRE(p.events.front() <= std::max(0, from));
    REQUIRE(p.events.front() >= std::max(0, from - 52));
    for (std::size_t k = 1; k < p.events.size(); ++k) REQUIRE(p.events[k] == p.events[k - 1] + 1);
  }
  p.player.seek(1e7);
  CHECK(p.player.position_s() == Approx(p.player.length_s()));
  p.player.seek(-5);
  CHECK(p.player.position_s() == 0);
}

TEST_CASE("A log opens at once, and its known length grows while it is scanned") {
  const auto log = one_minute_log();
  LogPlayer player{std::span<const std::uint8_t>(log->bytes)};
  double before_s = 0;
  do {
    CHECK(player.length_s() >= before_s);
    before_s = player.length_s();
  } while (player.scan_next());
  CHECK(player.length_s() == Approx(59.99));
}

TEST_CASE("A file that is no log is rejected with a sentence, and a damaged log is replayed without its damaged part") {
  const std::vector<std::uint8_t> nothing, text(1000, 'x');
  CHECK_THROWS_WITH(LogPlayer{std::span(nothing)}, Catch::Contains("no event"));
  CHECK_THROWS_WITH(LogPlayer{std::span(text)}, Catch::Contains("no event"));
  CHECK_THROWS_WITH(LogPlayer{std::string("/nowhere/run.lcmlog")}, Catch::Contains("/nowhere/run.lcmlog"));

  std::mt19937 random(4);
  for (int round = 0; round < 30; ++round) {
    PlayerFixture p;
    auto bytes = p.log->bytes;
    for (int i = 0; i < 20; ++i) bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    LogPlayer player{std::span<const std::uint8_t>(bytes)};
    while (player.scan_next()) {
    }
    player.play(true, 16);
    std::size_t events = 0;
    for (int i = 0; i < 100; ++i) {
      if (i % 10 == 0) player.seek(static_cast<double>(random() % 60));
      player.advance(sync::from_seconds(0.5), [&](std::string_view, std::span<const std::uint8_t>, sync::HostTime) { ++events; });
    }
    CHECK(events > 1000);
    CHECK(player.position_s() <= player.length_s());
  }
}
