#include "thermal_node/devices/dated_sender.h"

#include <catch2/catch.hpp>

#include "tests/thermal_node/support/device_time.h"

using namespace tactus;
using namespace std::chrono_literals;
using thermal::DatedSender;
using Result = DatedSender::Result;
using tactus::thermal::test::at;
using tactus::thermal::test::kClock;

namespace {

constexpr std::int32_t kForeign = 78;
constexpr auto kSilence = 300ms;

// A message of sender `who` with number `seq`, sent at sent_ms.
header_t header(std::int64_t who, std::int64_t seq, std::int64_t sent_ms, std::int32_t clock = kClock) {
  return {-1, sync::to_ns(at(sent_ms)), clock, 1, 9, who, seq};
}

}  // namespace

TEST_CASE("One sender is followed and trusted after the silence, without a pause") {
  DatedSender sender(kSilence, kClock);
  CHECK(sender.silent(at(0)));
  CHECK(sender.observe(header(5, 0, 0), at(1)) == Result::kRestart);
  CHECK_FALSE(sender.trusted(at(1)));
  for (int i = 1; i <= 30; ++i) CHECK(sender.observe(header(5, i, 10 * i), at(10 * i + 1)) == Result::kUse);
  CHECK(sender.trusted(at(301)));
  CHECK(sender.silent(at(602)));
  CHECK(sender.observe(header(5, 31, 700), at(701)) == Result::kRestart);
  CHECK_FALSE(sender.trusted(at(701)));
  CHECK(sender.followed() == 1);
}

TEST_CASE("A second sender is a conflict, and a successor is followed within twice the silence") {
  DatedSender sender(kSilence, kClock);
  int seq = 0;
  for (int ms = 0; ms < 1000; ms += 20) sender.observe(header(5, ++seq, ms), at(ms));
  CHECK_FALSE(sender.conflict(at(990)));
  for (int ms = 1000; ms < 2000; ms += 20) {
    sender.observe(header(5, ++seq, ms), at(ms));
    CHECK(sender.observe(header(6, seq, ms), at(ms)) == Result::kOther);
    CHECK(sender.conflict(at(ms)));
  }
  CHECK(sender.followed() == 1);
  // The first one ends.
  int taken_ms = 0;
  for (int ms = 2000; ms < 3000; ms += 20)
    if (sender.observe(header(6, ++seq, ms), at(ms)) == Result::kRestart) taken_ms = ms;
  CHECK(taken_ms > 2200);
  CHECK(taken_ms <= 2320);
  CHECK_FALSE(sender.conflict(at(2620)));
  CHECK(sender.trusted(at(2980)));
  CHECK(sender.followed() == 2);
}

TEST_CASE("Repeated and overtaken messages do not keep a sender alive") {
  DatedSender sender(kSilence, kClock);
  sender.observe(header(5, 10, 0), at(0));
  for (int ms = 20; ms <= 300; ms += 20)
    CHECK(sender.observe(header(5, 10 - ms / 100, 0), at(ms)) == Result::kRepeated);
  CHECK(sender.silent(at(301)));
  // Further repetitions: the sender is never trusted.
  for (int ms = 310; ms < 5000; ms += 20) {
    sender.observe(header(5, 10, 0, kForeign), at(ms));
    CHECK_FALSE(sender.trusted(at(ms)));
  }
}

TEST_CASE("A number far ahead hides the sender for no longer than four messages") {
  DatedSender sender(kSilence, kClock);
  sender.observe(header(5, std::int64_t{1} << 60, 0), at(0));
  int used = 0;
  for (int ms = 20; ms < 1000; ms += 20) used += sender.observe(header(5, ms, ms), at(ms)) != Result::kRepeated;
  CHECK(used == 49 - 3);
  CHECK(sender.trusted(at(990)));
}

TEST_CASE("Messages with a false date neither keep a sender alive nor make another one the followed one") {
  for (const std::int64_t false_ms : {-400, 100'000}) {
    CAPTURE(false_ms);
    DatedSender sender(kSilence, kClock);
    int seq = 0;
    CHECK(sender.observe(header(5, ++seq, 0), at(0)) == Result::kRestart);
    for (int ms = 20; ms < 2000; ms += 20) {
      const Result result = sender.observe(header(5, ++seq, ms + false_ms), at(ms));
      CHECK((result == Result::kLate || result == Result::kAhead));
      CHECK(sender.silent(at(ms)) == (ms > 300));
    }
    for (int ms = 2000; ms < 3000; ms += 20) {
      const Result result = sender.observe(header(6, ++seq, ms + false_ms), at(ms));
      CHECK((result == Result::kLate || result == Result::kAhead));
    }
    CHECK(sender.followed() == 1);
    // A true one is followed at once.
    CHECK(sender.observe(header(7, 1, 3000), at(3000)) == Result::kRestart);
    CHECK(sender.followed() == 2);
  }
}

TEST_CASE("A dated sender of another run is ignored and is no conflict") {
  DatedSender sender(kSilence, kClock, 2);
  CHECK(sender.observe(header(5, 1, 0), at(0)) == Result::kForeign);
  CHECK(sender.silent(at(0)));
  header_t own = header(6, 1, 10);
  own.run_id = 2;
  CHECK(sender.observe(own, at(10)) == Result::kRestart);
  CHECK(sender.observe(header(5, 2, 20), at(20)) == Result::kForeign);
  CHECK_FALSE(sender.conflict(at(20)));
}

TEST_CASE("A message that is dated ahead or too old is not used, by either clock") {
  for (const std::int32_t clock : {kClock, kForeign}) {
    INFO(clock);
    DatedSender sender(kSilence, kClock);
    // The other machine started ten minutes later.
    const std::int64_t offset_ms = clock == kClock ? 0 : -600'000;
    int seq = 0;
    for (int ms = 0; ms < 1000; ms += 20)
      CHECK(sender.observe(header(5, ++seq, ms + offset_ms, clock), at(ms + 2)) != Result::kAhead);
    CHECK(sender.observe(header(5, ++seq, 1000 + offset_ms + 100'000, clock), at(1002)) == Result::kAhead);
    CHECK(sender.ahead(at(1010)));
    CHECK_FALSE(sender.ahead(at(1310)));
    CHECK(sender.observe(header(5, ++seq, 1020 + offset_ms - 400, clock), at(1022)) == Result::kLate);
    CHECK(sender.observe(header(5, ++seq, 1040 + offset_ms, clock), at(1042)) == Result::kUse);
  }
}

TEST_CASE("The clock of another machine may drift for a day") {
  DatedSender sender(kSilence, kClock);
  int seq = 0;
  for (std::int64_t ms = 0; ms < 86'400'000; ms += 250) {
    const std::int64_t sent_ms = ms - ms / 10'000;  // 1e-4 slow
    REQUIRE(sender.observe(header(5, ++seq, sent_ms, kForeign), at(ms)) != Result::kLate);
    REQUIRE_FALSE(sender.ahead(at(ms)));
  }
}

TEST_CASE("A step of the own clock, in both directions, ends with the sender followed again") {
  for (const std::int64_t step_ms : {-500'000, 500'000}) {
    DatedSender sender(kSilence, kClock);
    int seq = 0;
    for (int ms = 0; ms < 1000; ms += 20) sender.observe(header(5, ++seq, ms), at(ms));
    for (int ms = 1000; ms < 2000; ms += 20) sender.observe(header(5, ++seq, ms + step_ms), at(ms + step_ms));
    CHECK(sender.trusted(at(1990 + step_ms)));
    CHECK_FALSE(sender.conflict(at(1990 + step_ms)));
    CHECK_FALSE(sender.ahead(at(1990 + step_ms)));
  }
}
