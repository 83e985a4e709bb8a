// Tests of the playout policies and the delays that they imply.
#include "sync/playout/policy.h"

#include <catch2/catch.hpp>

#include "tests/times.h"

using namespace tactus::sync;
using Catch::Contains;
using tactus::test::kMillisecond;

namespace {

const std::map<std::string, Nanoseconds> kNeeded{
    {"haptic", 2 * kMillisecond}, {"audio", 18 * kMillisecond}, {"visual", 35 * kMillisecond}, {"thermal", 25 * kMillisecond}};

PlayoutPlan plan_of(Policy policy) {
  PlayoutPlan p;
  p.policy = policy;
  return p;
}

}  // namespace

TEST_CASE("The policy asap has no delays") {
  for (const auto& [name, delay] : playout_delays(plan_of(Policy::kAsap), kNeeded)) CHECK(delay == 0 * kMillisecond);
}

TEST_CASE("The policy aligned delays all modalities to the slowest") {
  for (const auto& [name, delay] : playout_delays(plan_of(Policy::kAligned), kNeeded)) CHECK(delay == 35 * kMillisecond);
}

TEST_CASE("The policy local-haptic-first delays all modalities but touch to the slowest") {
  for (const auto& [name, delay] : playout_delays(plan_of(Policy::kLocalHapticFirst), kNeeded))
    CHECK(delay == (name == "haptic" ? 0 : 35) * kMillisecond);
}

TEST_CASE("A modality that exceeds the budget delays no other") {
  auto needed = kNeeded;
  needed["visual"] = 400 * kMillisecond;
  const auto delays = playout_delays(plan_of(Policy::kAligned), needed);
  CHECK(delays.at("audio") == 25 * kMillisecond);
  CHECK(delays.at("haptic") == 25 * kMillisecond);
}

TEST_CASE("A slow modality delays no other but is delayed with them") {
  auto needed = kNeeded;
  needed["thermal"] = 50 * kMillisecond;
  const auto delays = playout_delays(plan_of(Policy::kAligned), needed, {"thermal"});
  CHECK(delays.at("audio") == 35 * kMillisecond);
  CHECK(delays.at("thermal") == 35 * kMillisecond);
}

TEST_CASE("The policy experiment gives each modality its SOA relative to the base") {
  PlayoutPlan p = plan_of(Policy::kExperiment);
  p.base = 150 * kMillisecond;
  p.soa = parse_soa("audio=50ms,visual=-100ms,wind=-0.01s");
  const auto delays = playout_delays(p, kNeeded);
  CHECK(delays.at("audio") == 200 * kMillisecond);
  CHECK(delays.at("visual") == 50 * kMillisecond);
  CHECK(delays.at("haptic") == 150 * kMillisecond);
  CHECK(delays.at("wind") == 140 * kMillisecond);
}

TEST_CASE("The policy itouch2005 presents the modalities in series, and the loop takes the sum of their times") {
  const PlayoutPlan p = plan_of(Policy::kItouch2005);
  const auto delays = playout_delays(p, kNeeded);
  CHECK(delays.at("haptic") == 2 * kMillisecond);
  CHECK(delays.at("audio") == 20 * kMillisecond);
  CHECK(delays.at("visual") == 55 * kMillisecond);
  CHECK(delays.at("thermal") == 80 * kMillisecond);
  CHECK(lockstep_rate_Hz(p, kNeeded) == Approx(12.5));
  CHECK(lockstep_rate_Hz(plan_of(Policy::kAligned), kNeeded) == 0);
}

TEST_CASE("A fixed delay is the base, limited to the budget") {
  PlayoutPlan p = plan_of(Policy::kAligned);
  p.aligner = AlignerKind::kFixed;
  p.base = 40 * kMillisecond;
  CHECK(playout_delays(p, kNeeded).at("audio") == 40 * kMillisecond);
  p.base = 100 * kMillisecond;
  CHECK(playout_delays(p, kNeeded).at("audio") == p.budget);
}

TEST_CASE("An invalid plan is rejected with a remedy") {
  PlayoutPlan p = plan_of(Policy::kExperiment);
  p.base = 50 * kMillisecond;
  p.soa = parse_soa("audio=-80ms");
  CHECK_THROWS_WITH(p.check(), Contains("audio") && Contains("base of at least 80 ms"));
  p.soa = parse_soa("audio=-200.5ms");
  CHECK_THROWS_WITH(p.check(), Contains("base of at least 201 ms"));
  p.base = 201 * kMillisecond;
  CHECK_NOTHROW(p.check());
  p.policy = Policy::kAligned;
  CHECK_THROWS_WITH(p.check(), Contains("experiment"));
  CHECK_THROWS_WITH(parse_policy("serial"), Contains("itouch2005"));
  for (const char* wrong : {"audio", "=5ms", "audio=5kg", "audio=100s", "audio=", "audio=50", "audio=5ms,visual=-0.05"})
    CHECK_THROWS_AS(parse_soa(wrong), std::invalid_argument);
  for (const char* wrong : {"-1ms", "61s", "x", ""}) CHECK_THROWS_AS(parse_duration(wrong), std::invalid_argument);
}
