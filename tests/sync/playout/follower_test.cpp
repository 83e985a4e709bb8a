// Tests of the slew of a modality to its playout delay.
#include "sync/playout/follower.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/playout_t.hpp>
#include <vector>

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
  follower.push(playout_message("visual", 50 * kMillisecond), after_ms(0));
  for (int ms = 1; ms < 1000; ++ms) CHECK(follower.step(after_ms(ms)) == 20 * kMillisecond);
}

TEST_CASE("A received delay is approached at no more than 50 ms per second") {
  PlayoutFollower follower("audio");
  follower.set_own(20 * kMillisecond);
  follower.step(after_ms(0));
  follower.push(playout_message("audio", 45 * kMillisecond), after_ms(0));
  Nanoseconds before = 20 * kMillisecond;
  for (int ms = 1; ms <= 600; ++ms) {
    const Nanoseconds now = follower.step(after_ms(ms));
    CHECK(now >= before);
    CHECK(now - before <= kMillisecond / 20);
    before = now;
  }
  CHECK(before == 45 * kMillisecond);  // 25 ms take half a second
  // After a long pause a process steps by at most the amount of 1 s.
  follower.push(playout_message("audio", Nanoseconds(0)), after_ms(600));
  CHECK(follower.step(after_ms(60'000)) == 0 * kMillisecond);
  follower.push(playout_message("audio", 200 * kMillisecond), after_ms(60'000));
  CHECK(follower.step(after_ms(120'000)) == 50 * kMillisecond);
}

TEST_CASE("The follower adopts and leaves the policy asap as received") {
  PlayoutFollower follower("audio");
  CHECK_FALSE(follower.as_soon_as_possible());
  follower.push(playout_message("audio", Nanoseconds(0), playout_t::ASAP), after_ms(0));
  CHECK(follower.as_soon_as_possible());
  follower.push(playout_message("audio", 30 * kMillisecond), after_ms(1));
  CHECK_FALSE(follower.as_soon_as_possible());
}

TEST_CASE("The presentation of an instant does not depend on the phase of the ticks, also while the delay changes") {
  const auto presentations = [](Nanoseconds phase) {
    PlayoutFollower follower("audio");
    follower.set_own(20 * kMillisecond);
    std::vector<HostTime> times;
    for (int ms = 0; ms < 400; ++ms) {
      const HostTime now = after_ms(ms) + phase;
      if (ms == 100) follower.push(playout_message("audio", 30 * kMillisecond), after_ms(100));
      if (ms == 250) follower.push(playout_message("audio", 22 * kMillisecond), after_ms(250));
      follower.step(now);
      // An instant whose presentation is 5 ms ahead, on a grid of 1 ms.
      times.push_back(follower.presentation_of(after_ms(ms + 5) - follower.delay() - (after_ms(ms + 5) - follower.delay()).time_since_epoch() % kMillisecond,
                                               Nanoseconds(0)));
    }
    return times;
  };
  const auto early = presentations(Nanoseconds(0)), late = presentations(Nanoseconds(700'000));
  int compared = 0;
  for (const HostTime t : late) {
    const auto nearest = std::lower_bound(early.begin(), early.end(), t - kMillisecond / 2);
    REQUIRE(nearest != early.end());
    // A delay that is published between the tick and the presentation is known only to the later tick.
    const bool is_new = (t > after_ms(100) && t < after_ms(107)) || (t > after_ms(250) && t < after_ms(257));
    if (is_new) continue;
    CHECK(std::abs(to_seconds(*nearest - t)) < 1e-6);
    ++compared;
  }
  CHECK(compared > 350);
}
