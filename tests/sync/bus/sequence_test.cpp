// Tests of sequence numbers: gaps, late and repeated messages, restarts and several senders.
#include "sync/bus/sequence.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <set>
#include <tactus/header_t.hpp>
#include <vector>

using namespace tactus;
using sync::SequenceStatus;
using sync::SequenceTracker;

namespace {
header_t message(std::int64_t seq, std::int64_t publish_ms, std::int64_t incarnation = 7,
                 std::int32_t source = 1) {
  header_t h{};
  h.seq = seq;
  h.publish_time_ns = publish_ms * 1'000'000;
  h.incarnation = incarnation;
  h.source = source;
  return h;
}
}  // namespace

TEST_CASE("Missing sequence numbers are counted as gaps") {
  SequenceTracker t;
  CHECK(t.observe(message(10, 0)) == SequenceStatus::kNewIncarnation);  // joined late: no gap
  CHECK(t.observe(message(11, 1)) == SequenceStatus::kNew);
  CHECK(t.observe(message(15, 5)) == SequenceStatus::kNew);
  CHECK(t.gaps() == 3);
  CHECK(t.messages() == 3);
}

TEST_CASE("A late message closes its gap, a repeated one does not") {
  SequenceTracker t;
  t.observe(message(0, 0));
  t.observe(message(3, 3));
  REQUIRE(t.gaps() == 2);
  CHECK(t.observe(message(1, 1)) == SequenceStatus::kOld);
  CHECK(t.gaps() == 1);
  SECTION("repeated messages are old and change no gap") {
    CHECK(t.observe(message(1, 1)) == SequenceStatus::kOld);
    CHECK(t.observe(message(0, 0)) == SequenceStatus::kOld);
    CHECK(t.observe(message(3, 3)) == SequenceStatus::kOld);
    CHECK(t.gaps() == 1);
  }
}

TEST_CASE("A restart is not a gap") {
  SequenceTracker t;
  t.observe(message(1000, 0, 7));
  CHECK(t.observe(message(0, 1, 8)) == SequenceStatus::kNewIncarnation);
  CHECK(t.observe(message(1, 2, 8)) == SequenceStatus::kNew);
  CHECK(t.gaps() == 0);
}

TEST_CASE("A clock that steps back by more than a second within an incarnation is a new epoch") {
  SequenceTracker t;
  t.observe(message(500, 60'000));
  CHECK(t.observe(message(499, 59'500)) == SequenceStatus::kOld);
  CHECK(t.observe(message(3, 100)) == SequenceStatus::kNewEpoch);
  CHECK(t.observe(message(4, 101)) == SequenceStatus::kNew);
  CHECK(t.gaps() == 0);
}

TEST_CASE("A message with a sequence number far ahead does not block later messages") {
  SequenceTracker t;
  t.observe(message(10, 10));
  SECTION("beyond the largest possible loss, the next message is accepted at once") {
    CHECK(t.observe(message(std::numeric_limits<std::int64_t>::max(), 11)) == SequenceStatus::kNewEpoch);
    CHECK(t.observe(message(11, 11)) == SequenceStatus::kNewEpoch);
    CHECK(t.observe(message(12, 12)) == SequenceStatus::kNew);
    CHECK(t.gaps() == 0);
  }
  SECTION("within it, the third contradicting message is accepted") {
    CHECK(t.observe(message(1'000'000, 11)) == SequenceStatus::kNew);
    CHECK(t.observe(message(11, 12)) == SequenceStatus::kOld);
    CHECK(t.observe(message(12, 13)) == SequenceStatus::kOld);
    CHECK(t.observe(message(13, 14)) == SequenceStatus::kNewEpoch);
    CHECK(t.observe(message(14, 15)) == SequenceStatus::kNew);
  }
  SECTION("with a stamp up to a second ahead, messages are accepted after about 900") {
    CHECK(t.observe(message(1'000'000, 910)) == SequenceStatus::kNew);
    int old = 0;
    for (int i = 1; i < 1100; ++i) old += t.observe(message(10 + i, 10 + i)) == SequenceStatus::kOld;
    CHECK(old <= 903);
  }
}

TEST_CASE("A repeated burst is old, also if it is long") {
  SequenceTracker t;
  for (int i = 0; i < 500; ++i) t.observe(message(i, i));
  for (int i = 0; i < 500; ++i) REQUIRE(t.observe(message(i, i)) == SequenceStatus::kOld);
  CHECK(t.observe(message(500, 500)) == SequenceStatus::kNew);
}

TEST_CASE("When there are too many senders, the one that was silent longest is forgotten and counted") {
  SequenceTracker t;
  t.observe(message(1, 1, 7, -1));
  for (std::int32_t source = 0; source < 300; ++source) {
    t.observe(message(1, 1, 7, source));
    if (source == 200) t.observe(message(2, 2, 7, -1));
  }
  CHECK(t.forgotten() == 45);
  CHECK(t.observe(message(3, 3, 7, -1)) == SequenceStatus::kNew);
  CHECK(t.observe(message(2, 2, 7, 0)) == SequenceStatus::kNewIncarnation);
}

TEST_CASE("Each source on a channel has its own sequence numbers") {
  SequenceTracker t;
  for (int i = 0; i < 10; ++i)
    for (std::int32_t source = 1; source <= 3; ++source) t.observe(message(i, i, 7, source));
  CHECK(t.gaps() == 0);
  CHECK(t.messages() == 30);
}

TEST_CASE("Gaps equal the lost messages for any reordering and repetition") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<std::int64_t> sent, arrived;
    for (int i = 0; i < 200; ++i) sent.push_back(i);
    std::set<std::int64_t> lost;
    for (const std::int64_t seq : sent) {
      if (seq > 0 && seq < 199 && random() % 10 == 0) {
        lost.insert(seq);
        continue;
      }
      arrived.push_back(seq);
      if (random() % 10 == 0) arrived.push_back(seq);
    }
    // Reorders by up to five places; the first and the last message keep their places.
    for (std::size_t i = 1; i + 6 < arrived.size(); ++i) std::swap(arrived[i], arrived[i + random() % 5]);
    SequenceTracker t;
    for (const std::int64_t seq : arrived) t.observe(message(seq, seq));
    REQUIRE(t.gaps() == static_cast<std::int64_t>(lost.size()));
  }
}

TEST_CASE("A late message closes a gap among the newest numbers, and no older one") {
  std::mt19937 random(5);
  const auto below = [&](std::int64_t n) { return static_cast<std::int64_t>(random() % static_cast<unsigned>(n)); };
  for (int trial = 0; trial < 50; ++trial) {
    SequenceTracker t;
    std::set<std::int64_t> missing;  // all of the sender
    std::int64_t newest = 0, gaps = 0;
    t.observe(message(newest, 0));
    for (int i = 0; i < 400; ++i) {
      if (random() % 2 == 0) {
        const std::int64_t next = newest + 1 + below(random() % 8 == 0 ? 3000 : 4);
        for (std::int64_t seq = newest + 1; seq < next; ++seq) missing.insert(seq), ++gaps;
        newest = next;
        t.observe(message(newest, 0));
      } else {
        const std::int64_t late = newest - below(2 * SequenceTracker::kRemembered);
        const bool remembered = newest - late <= SequenceTracker::kRemembered;
        if (missing.erase(late) > 0 && remembered) --gaps;
        REQUIRE(t.observe(message(late, 0)) == SequenceStatus::kOld);
      }
      REQUIRE(t.gaps() == gaps);
    }
  }
}
