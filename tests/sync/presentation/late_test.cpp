// Tests of the policies for late events.
#include "sync/presentation/late.h"

#include <catch2/catch.hpp>
#include <tactus/presentation_t.hpp>

using namespace tactus;
using namespace tactus::sync;
using namespace std::chrono_literals;

namespace {

constexpr std::int8_t kPresented = presentation_t::PRESENTED, kLateOutcome = presentation_t::LATE,
                      kDropped = presentation_t::DROPPED_LATE;
LatePolicy of(LateRule rule) { return {rule, 10ms, 30ms}; }

}  // namespace

TEST_CASE("Events that are early or within the tolerance are presented at full gain under any rule") {
  const LateRule rule = GENERATE(LateRule::kPlayWithFade, LateRule::kDrop, LateRule::kShowNewest, LateRule::kAlwaysApply);
  for (const Nanoseconds lateness : {Nanoseconds(-1h), Nanoseconds(0), Nanoseconds(10ms)}) {
    CHECK(of(rule).outcome(lateness) == kPresented);
    CHECK(of(rule).gain(lateness) == 1);
  }
}

TEST_CASE("Events between tolerance and limit are presented late") {
  const LateRule rule = GENERATE(LateRule::kPlayWithFade, LateRule::kDrop, LateRule::kShowNewest, LateRule::kAlwaysApply);
  CHECK(of(rule).outcome(10ms + 1ns) == kLateOutcome);
  CHECK(of(rule).outcome(30ms) == kLateOutcome);
}

TEST_CASE("Events beyond the limit are dropped unless the rule is to apply always") {
  for (const LateRule rule : {LateRule::kPlayWithFade, LateRule::kDrop, LateRule::kShowNewest}) {
    CHECK(of(rule).outcome(30ms + 1ns) == kDropped);
    CHECK(of(rule).outcome(1h) == kDropped);
  }
  CHECK(of(LateRule::kAlwaysApply).outcome(1h) == kLateOutcome);
}

TEST_CASE("Only play-with-fade reduces the gain, linearly to zero at the limit") {
  const LatePolicy fades = of(LateRule::kPlayWithFade);
  CHECK(fades.gain(15ms) == Approx(0.75));
  CHECK(fades.gain(20ms) == Approx(0.5));
  CHECK(fades.gain(30ms) == 0);
  CHECK(fades.gain(1h) == 0);
  for (const LateRule rule : {LateRule::kDrop, LateRule::kShowNewest, LateRule::kAlwaysApply}) CHECK(of(rule).gain(20ms) == 1);
}

TEST_CASE("If limit and tolerance are equal, an event is on time or dropped") {
  const LatePolicy sharp{LateRule::kPlayWithFade, 10ms, 10ms};
  CHECK(sharp.outcome(10ms) == kPresented);
  CHECK(sharp.gain(10ms) == 1);
  CHECK(sharp.outcome(10ms + 1ns) == kDropped);
  CHECK(sharp.gain(10ms + 1ns) == 0);
}
