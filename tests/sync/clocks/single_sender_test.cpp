// One table of situations, run for each output that has one sender at a time.
#include "sync/clocks/single_sender.h"

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <tactus/header_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kRunId = 7;

// How the receiver of an output follows its sender.
struct Output {
  const char* channel;
  double rate_Hz;       // of its messages
  std::int64_t run_id;  // the only accepted run, or kAnyRun
  bool pages;           // its messages overtake each other
};
const std::vector<Output> kOutputs{
    {channels::kToolState, 1000, kRunId, false},
    {channels::kDeviceState, 1000, SingleSender::kAnyRun, false},
    {channels::kDeviceForce, 1000, SingleSender::kAnyRun, false},
    {channels::kThermalState, 50, SingleSender::kAnyRun, false},
    {channels::kThermalDevice, 10, SingleSender::kAnyRun, false},
    {channels::kTouchModel, 1000, SingleSender::kAnyRun, true},
    {channels::kContactEvents, 1000, SingleSender::kAnyRun, true},
    {channels::kContacts, 60, SingleSender::kAnyRun, true},
    {channels::kWorldState, 60, SingleSender::kAnyRun, true},
};

struct Sender {
  std::int64_t incarnation, run_id = kRunId, seq = 0, clock_ns = 0;
  header_t next(std::int64_t arrival_ns) {
    header_t h{};
    h.incarnation = incarnation;
    h.run_id = run_id;
    h.seq = seq++;
    h.publish_time_ns = clock_ns + arrival_ns;
    return h;
  }
};

// The receiver of one output, and the time, which the test moves.
struct Receiver {
  Output output;
  SingleSender followed{output.run_id};
  std::int64_t now_ns = 5'000 * kMs;
  std::int64_t period_ns = static_cast<std::int64_t>(1e9 / output.rate_Hz);

  HostTime now() const { return host_time(now_ns); }
  SenderStatus receive(const header_t& h) { return output.pages ? followed.on_page(h, now()) : followed.on_message(h, now()); }
  SenderStatus receive(Sender& s) { return receive(s.next(now_ns)); }
  // The sender sends for a time; returns the number of accepted messages.
  int run(Sender& s, std::int64_t duration_ns, std::vector<Sender*> others = {}) {
    int used = 0;
    for (const std::int64_t end = now_ns + duration_ns; now_ns < end; now_ns += period_ns) {
      used += accepted(receive(s));
      for (Sender* other : others) used += 1000 * accepted(receive(*other));
    }
    return used;
  }
};

// Runs the test that calls it once for each row of the table.
Receiver each_output() { return Receiver{kOutputs[GENERATE(range(std::size_t{0}, kOutputs.size()))]}; }

}  // namespace

TEST_CASE("Each output follows its first sender, whose messages are used once each") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender a{1};
  CHECK(r.followed.silent(r.now()));
  CHECK(r.receive(a) == SenderStatus::kFirst);
  CHECK(r.receive(a) == SenderStatus::kCurrent);
  CHECK(r.followed.incarnation() == 1);
  CHECK(r.followed.run_id() == kRunId);
  CHECK(r.run(a, 1'000 * kMs) == Approx(r.output.rate_Hz).margin(1));
  CHECK_FALSE(r.followed.conflict(r.now()));
  CHECK_FALSE(r.followed.silent(r.now()));
}

TEST_CASE("A second sender of an output is a conflict and changes nothing for the first one") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender a{1}, b{2, kRunId, 900'000, 40 * kMs};
  r.run(a, 500 * kMs);
  const int used = r.run(a, 500 * kMs, {&b});
  CHECK(used == Approx(0.5 * r.output.rate_Hz).margin(1));  // all of the first one, none of the second one
  CHECK(r.followed.incarnation() == 1);
  CHECK(r.followed.conflict(r.now()));
  SECTION("the conflict ends 0.3 s after the second sender") {
    r.run(a, 310 * kMs);
    CHECK_FALSE(r.followed.conflict(r.now()));
    CHECK(r.receive(a) == SenderStatus::kCurrent);
  }
  SECTION("any number of senders with random incarnations changes nothing either") {
    std::mt19937_64 random(4);
    for (int i = 0; i < 20'000; ++i) {
      if (i % 20 == 0) CHECK(r.receive(a) == SenderStatus::kCurrent);
      Sender other{static_cast<std::int64_t>(random() >> 2) + 3, kRunId, static_cast<std::int64_t>(random() >> 1),
                   static_cast<std::int64_t>(random() >> 4)};
      CHECK(r.receive(other) == SenderStatus::kConflict);
      r.now_ns += r.period_ns / 20;
    }
    CHECK(r.followed.incarnation() == 1);
  }
}

TEST_CASE("A successor takes over an output after 0.3 s of silence, and its first message starts all sums") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender a{1}, b{2};
  r.run(a, 500 * kMs);
  r.now_ns -= r.period_ns;  // the arrival of its last message
  const std::int64_t last_ns = r.now_ns;
  r.now_ns = last_ns + 299 * kMs;
  CHECK(r.receive(b) == SenderStatus::kConflict);
  r.now_ns = last_ns + 300 * kMs;
  CHECK(r.receive(b) == SenderStatus::kFirst);
  CHECK(r.receive(b) == SenderStatus::kCurrent);
  SECTION("late messages of the old one are conflicts, not news") { CHECK(r.receive(a) == SenderStatus::kConflict); }
  SECTION("the old one is followed again once its successor is silent for 0.3 s") {
    r.run(b, 1'000 * kMs, {&a});
    CHECK(r.followed.incarnation() == 2);
    r.now_ns += 300 * kMs;
    CHECK(r.receive(a) == SenderStatus::kFirst);
    CHECK(r.receive(b) == SenderStatus::kConflict);
  }
}

TEST_CASE("A sender of an output that continues after a silence continues its sums") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender a{1};
  r.run(a, 100 * kMs);
  r.now_ns += 10'000 * kMs;
  CHECK(r.followed.silent(r.now()));
  CHECK(r.receive(a) == SenderStatus::kCurrent);
}

TEST_CASE("The same incarnation in another run is another sender of an output") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender live{1}, recorded{1, kRunId + 1};
  r.run(live, 100 * kMs);
  const SenderStatus expected = r.output.run_id == SingleSender::kAnyRun ? SenderStatus::kConflict : SenderStatus::kForeign;
  CHECK(r.receive(recorded) == expected);
  CHECK(r.receive(live) == SenderStatus::kCurrent);
  CHECK(r.followed.foreign() == (expected == SenderStatus::kForeign));
  r.now_ns += 1'000 * kMs;
  CHECK(r.receive(recorded) == (expected == SenderStatus::kForeign ? SenderStatus::kForeign : SenderStatus::kFirst));
}

TEST_CASE("A repeated or overtaken message of an output is used at most once, unless it is a page") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender a{1};
  r.run(a, 100 * kMs);
  const header_t first = a.next(r.now_ns), second = a.next(r.now_ns + kMs);
  CHECK(r.receive(second) == SenderStatus::kCurrent);
  const SenderStatus expected = r.output.pages ? SenderStatus::kCurrent : SenderStatus::kOld;
  for (int i = 0; i < 10; ++i) {
    CHECK(r.receive(first) == expected);
    CHECK(r.receive(second) == expected);
  }
  CHECK(r.receive(a) == SenderStatus::kCurrent);
}

TEST_CASE("No number and no stamp silences the sender of an output") {
  Receiver r = each_output();
  INFO(r.output.channel);
  Sender a{1};
  r.run(a, 100 * kMs);
  header_t forged = a.next(r.now_ns);
  SECTION("a number far ahead is ignored") {
    forged.seq = INT64_MAX;
    CHECK(r.receive(forged) == (r.output.pages ? SenderStatus::kCurrent : SenderStatus::kOld));
  }
  SECTION("a number that is a little ahead counts as false after three messages") { forged.seq += 500, r.receive(forged); }
  SECTION("a stamp far ahead has no effect") { forged.publish_time_ns = 1'000'000'000'000'000'000, r.receive(forged); }
  SECTION("the numbers begin again, as in a log that is replayed again") { a.seq = 0, a.clock_ns = -3'000 * kMs; }
  int lost = 0;
  for (int i = 0; i < 20; ++i) {
    r.now_ns += r.period_ns;
    lost += !accepted(r.receive(a));
  }
  CHECK(lost < SingleSender::kMaxContradictions);
  CHECK(accepted(r.receive(a)));
}
