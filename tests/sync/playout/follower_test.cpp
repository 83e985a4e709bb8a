// Tests of the slew of a modality to its playout delay.
#include "sync/playout/follower.h"

#include <catch2/catch.hpp>
#include <tactus/playout_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMillisecond;

namespace {

HostTime after_ms(int ms) { return host_time(7'000'000'000 + std::int64_t{ms} * kMillisecond.count()); }

playout_t playout_message(const std::string& modality, Nanoseconds delay, std::int8_t policy = playout_t::ALIGNED) {
  playout_t m{};
  m.policy = policy;
  m.entries = {{modality, delay.count(), 0, -1}};
  m.count = 1;
  return m;
}

}  // namespace

TEST_CASE("A modality keeps its own delay until it receives another one") {
  PlayoutFollower follower("audio");
  follower.set_own(20 * kMillisecond);
  CHECK(follower.step(after_ms(0)) == 20 * kMillisecond);
  follower.push(playout_message("visual", 50 * kMillisecond));
  for (int ms = 1; ms < 1000; ++ms) CHECK(follower.step(after_ms(ms)) == 20 * kMillisecond);
}

TEST_CASE("A received delay is approached at no more than 50 ms per second") {
  PlayoutFollower follower("audio");
  follower.set_own(20 * kMillisecond);
  follower.step(after_ms(0));
  follower.push(playout_message("audio", 45 * kMillisecond));
  Nanoseconds before = 20 * kMillisecond;
  for (int ms = 1; ms <= 600; ++ms) {
    const Nanoseconds now = follower.step(after_ms(ms));
    CHECK(now >= before);
    CHECK(now - before <= kMillisecond / 20);
    before = now;
  }
  CHECK(before == 45 * kMillisecond);  // 25 ms take half a second
  // After a long pause a process steps by at most the amount of 1 s.
  follower.push(playout_message("audio", Nanoseconds(0)));
  CHECK(follower.step(after_ms(60'000)) == 0 * kMillisecond);
  follower.push(playout_message("audio", 200 * kMillisecond));
  CHECK(follower.step(after_ms(120'000)) == 50 * kMillisecond);
}

TEST_CASE("The follower adopts and leaves the policy asap as received") {
  PlayoutFollower follower("audio");
  CHECK_FALSE(follower.as_soon_as_possible());
  follower.push(playout_message("audio", Nanoseconds(0), playout_t::ASAP));
  CHECK(follower.as_soon_as_possible());
  follower.push(playout_message("audio", 30 * kMillisecond));
  CHECK_FALSE(follower.as_soon_as_possible());
}
