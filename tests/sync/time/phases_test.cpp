// Durations of the phases of a tick, on a manual clock.
#include "sync/time/phases.h"

#include <catch2/catch.hpp>
#include <thread>

using namespace tactus::sync;

namespace {

HostTime now{};
HostTime by_hand() { return now; }
void pass_us(std::int64_t us) { now += Nanoseconds(1000 * us); }

}  // namespace

TEST_CASE("Each phase has its own time without nested phases, and the rest counts as other") {
  Phases phases(by_hand);
  phases.begin(true);
  pass_us(5);
  {
    const ScopedPhaseTimer solve(Phase::kSolve);
    pass_us(20);
    {
      const ScopedPhaseTimer collision(Phase::kCollision);
      pass_us(7);
    }
    pass_us(1);
  }
  pass_us(2);
  {
    const ScopedPhaseTimer collision(Phase::kCollision);
    pass_us(3);
  }
  phases.end();
  CHECK(*phases.us_pointer(Phase::kOther) == 7);
  CHECK(*phases.us_pointer(Phase::kSolve) == 21);
  CHECK(*phases.us_pointer(Phase::kCollision) == 10);
  CHECK(*phases.us_pointer(Phase::kRender) == 0);
  phases.begin(true);
  pass_us(4);
  phases.end();
  CHECK(*phases.us_pointer(Phase::kOther) == 4);
  CHECK(*phases.us_pointer(Phase::kSolve) == 0);
}

TEST_CASE("A phase timer reads no clock in an unmeasured tick or on another thread") {
  static int read = 0;
  Phases phases([] { return ++read, HostTime{}; });
  phases.begin(false);
  { const ScopedPhaseTimer solve(Phase::kSolve); }
  phases.end();
  CHECK(read == 0);
  phases.begin(true);
  const int before = read;
  std::thread([] { const ScopedPhaseTimer solve(Phase::kSolve); }).join();
  CHECK(read == before);
  phases.end();
}
