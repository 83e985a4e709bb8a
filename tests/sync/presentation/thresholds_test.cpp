// Tests of the published thresholds of asynchrony.
#include "sync/presentation/thresholds.h"

#include <catch2/catch.hpp>

#include "tests/times.h"

using namespace tactus::sync;
using tactus::test::kMillisecond;

TEST_CASE("Every published threshold has a pair, a time, a meaning, a situation and a source") {
  REQUIRE(published_thresholds().size() >= 10);
  for (const Threshold& t : published_thresholds()) {
    CHECK(t.earlier != t.later);
    CHECK(t.at > 0 * kMillisecond);
    CHECK(t.at < 1000 * kMillisecond);
    CHECK_FALSE((t.what.empty() || t.situation.empty() || t.source.empty()));
  }
}

TEST_CASE("Thresholds depend on the order: touch before vision has a lower one than vision before touch") {
  CHECK(thresholds_of("haptic", "visual")->least == 15 * kMillisecond);
  CHECK(thresholds_of("visual", "haptic")->least == 45 * kMillisecond);
  CHECK(thresholds_of("visual", "audio")->least == 45 * kMillisecond);
  CHECK(thresholds_of("visual", "audio")->largest == 185 * kMillisecond);
  CHECK_FALSE(thresholds_of("haptic", "thermal"));
}

TEST_CASE("Asynchronies beyond the lowest and beyond all thresholds of their direction are counted") {
  SoaHistogram soa;
  for (const int ms : {0, 10, 20, 60, 95, -10, -50, -70, -130, -190}) soa.add(ms * kMillisecond, Nanoseconds(0));
  // audio, then visual: 15 to 90 ms; visual, then audio: 45 to 185 ms
  const BeyondThresholds beyond = count_beyond_thresholds("audio", "visual", soa);
  CHECK(beyond.least == 3 + 4);
  CHECK(beyond.all == 1 + 1);
  CHECK(count_beyond_thresholds("haptic", "thermal", soa).least == -1);
  // haptic, then audio: 24 to 100 ms; nothing is published for sound before touch
  CHECK(count_beyond_thresholds("haptic", "audio", soa).least == 2);
  CHECK(count_beyond_thresholds("haptic", "audio", soa).all == 0);
}

TEST_CASE("The thresholds of touch also apply to its constraint force") {
  SoaHistogram late;
  for (int i = 0; i < 4; ++i) late.add(Nanoseconds(900'000'000), Nanoseconds(0));
  const BeyondThresholds vibration = count_beyond_thresholds("haptic", "audio", late),
               push = count_beyond_thresholds("haptic_push", "audio", late);
  CHECK(vibration.all == 4);
  CHECK(push.all == vibration.all);
  CHECK(push.least == vibration.least);
}
