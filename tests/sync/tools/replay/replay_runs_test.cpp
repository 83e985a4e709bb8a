// Tests of replaying logs with several runs and with any channel names.
#include <catch2/catch.hpp>

#include "sync/tools/replay/replay.h"
#include "sync/tools/replay/replay_selection.h"
#include "tests/sync/support/log_of_run.h"

using namespace tactus;
using namespace tactus::sync;

TEST_CASE("A log of two runs is replayed run by run, or as a whole") {
  const TestEvents a = events_of({.ticks = 300}), b = events_of({.scene = "two.sdf", .ticks = 200, .text = "other"});
  const std::vector<std::uint8_t> bytes = log_bytes(a + b);
  LogIndex index(bytes);
  index.read_all();
  const auto sent_of = [&](int run) {
    ReplayOptions o;
    o.speed = 0, o.max_per_s = 1e6, o.from_head = true;
    Replay replay(index, run, o, host_time(900'000'000'000));
    std::size_t sent = 0;
    HostTime now = host_time(900'000'000'000);
    for (int i = 0; i < 200 && !replay.over(); ++i)
      replay.poll(now += Nanoseconds(1'000'000), [&](const LogEvent&, const ReplayMoment&) { return ++sent, true; });
    CHECK(replay.over());
    return sent;
  };
  CHECK(sent_of(1) == a.size());
  CHECK(sent_of(2) == b.size());
  CHECK(sent_of(TimestampedEvents::kWholeFile) == a.size() + b.size());
}

TEST_CASE("A channel is renamed to any name that LCM can send") {
  CHECK(ReplaySelection({.rename = {"POSE=imu data \xc3\x9c"}}).channel_of({0, 0, "POSE", {}}) == std::string_view("imu data \xc3\x9c"));
}
