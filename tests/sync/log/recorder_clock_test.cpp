// Tests of the recorder's clock with messages whose time of sending is false.
#include "sync/log/recorder_clock.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sync/bus/decode.h"
#include "tests/sync/support/log_of_run.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

void send_later_us(TestEvent& event, std::int64_t by_us) {
  auto m = decode<node_health_t>(event.data.data(), event.data.size());
  REQUIRE(m);
  m->header.publish_time_ns += 1000 * by_us;
  event.data = encode(*m);
}

// From 1 ms to a day, in either direction: the times of sending are positive.
std::int64_t drawn_us(std::mt19937_64& random, double longest_s = 86'400) {
  const double size_s = 1e-3 * std::pow(longest_s / 1e-3, static_cast<double>(random() % 1001) / 1000);
  return static_cast<std::int64_t>(size_s * 1e6) * (random() % 2 ? 1 : -1);
}

}  // namespace

TEST_CASE("One false time of sending, first or later, sets no sender's clock: jumps and pauses are found as without it") {
  std::mt19937_64 random(5);
  for (int round = 0; round < 120; ++round) {
    const TestEvents right = events_of({.nodes = 1 + round % 3, .begin_ns = 100'000'000'000'000});
    const std::size_t nodes = static_cast<std::size_t>(1 + round % 3);
    TestEvents events = right;
    // The first message of a sender, or any.
    const std::size_t forged = 1 + (round % 2 ? random() % nodes : random() % (events.size() / 3));
    const std::int64_t by_us = drawn_us(random);
    send_later_us(events[forged], by_us);
    // The recorder's clock jumps, or nothing is sent for a second.
    const std::size_t at = events.size() / 2;
    std::int64_t jump_us = 0;
    if (round % 4 < 2) {
      while (std::abs(jump_us) < 150'000) jump_us = drawn_us(random);
      for (std::size_t i = at; i < events.size(); ++i) events[i].stamp_us += jump_us;
    } else {
      events.erase(events.begin() + static_cast<std::ptrdiff_t>(at), events.begin() + static_cast<std::ptrdiff_t>(at + 200 * nodes));
    }
    const auto bytes = log_bytes(events);
    LogIndex index(bytes);
    index.read_all();
    INFO("round " << round << ", message " << forged << " sent " << by_us << " us later, jump of " << jump_us << " us");
    REQUIRE(index.runs().size() == 1);
    REQUIRE(index.run(1).jumps.size() == (jump_us != 0));
    if (jump_us != 0) CHECK(std::abs(index.run(1).jumps[0].by_us - jump_us) <= 1000);
    CHECK(std::abs(index.run(1).last_us - right.back().stamp_us) <= 1000);
    CHECK(index.run(1).misdated == 0);
    const bool implausible = by_us > RecorderClock::kPause_us + 1000 || by_us < -RecorderClock::kMaxStep_us - 1000;
    if (std::abs(by_us - RecorderClock::kPause_us) > 1000 && std::abs(by_us + RecorderClock::kMaxStep_us) > 1000)
      CHECK(index.run(1).contradicting == implausible);
    CHECK(index.warnings(1).size() == static_cast<std::size_t>(implausible) + (jump_us != 0));
  }
}

TEST_CASE("Two false times of sending among the first five of a sender change nothing") {
  std::mt19937_64 random(6);
  for (int round = 0; round < 60; ++round) {
    TestEvents events = events_of({.nodes = 1, .begin_ns = 100'000'000'000'000});
    const TestEvents right = events;
    const std::size_t first = 1 + random() % 5;
    send_later_us(events[first], drawn_us(random, 0.09));
    send_later_us(events[1 + (first + random() % 4) % 5], drawn_us(random, 0.09));
    events.erase(events.begin() + 400, events.begin() + 700);
    const auto bytes = log_bytes(events);
    LogIndex index(bytes);
    index.read_all();
    INFO("round " << round);
    CHECK(index.run(1).jumps.empty());
    CHECK(index.run(1).last_us == right.back().stamp_us);
    CHECK(index.warnings(1).empty());
  }
}

TEST_CASE("A warning counts the false times of sending") {
  TestEvents events = events_of({});
  for (const std::size_t i : {4u, 900u, 1700u}) send_later_us(events[i], 3'600'000'000);
  const auto bytes = log_bytes(events);
  LogIndex index(bytes);
  index.read_all();
  REQUIRE(index.warnings(1).size() == 1);
  CHECK_THAT(index.warnings(1)[0], Catch::StartsWith("3 messages have a time of sending that contradicts"));
}
