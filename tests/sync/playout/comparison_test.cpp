// Tests of the comparison of aligners on a trace.
#include "sync/playout/comparison.h"

#include <catch2/catch.hpp>

using namespace tactus::sync;

namespace {
constexpr Nanoseconds kMs{1'000'000};
}

TEST_CASE("With a delay that suffices all senses are presented together, and with none as soon as each can") {
  const std::vector<TraceEvent> trace(100, {{"audio", 20 * kMs}, {"visual", 35 * kMs}});
  const auto enough = simulate_aligner(trace, AlignerKind::kFixed, 40 * kMs);
  CHECK(enough.asynchrony_p95 == 0 * kMs);
  CHECK(enough.late_share == 0);
  CHECK(enough.added_mean == Nanoseconds(12'500'000));  // 20 and 5 ms
  CHECK(enough.events == 68);
  const auto none = simulate_aligner(trace, AlignerKind::kFixed, 0 * kMs);
  CHECK(none.asynchrony_p50 == 15 * kMs);
  CHECK(none.late_share == 1);
  CHECK(none.added_mean == 0 * kMs);
}

TEST_CASE("All wait for the sense that needs most, by its own aligner") {
  const std::vector<TraceEvent> trace(200, {{"audio", 20 * kMs}, {"visual", 35 * kMs}});
  const auto r = simulate_aligner(trace, AlignerKind::kQuantile, 0 * kMs);
  CHECK(r.delay_last == 35 * kMs);
  CHECK(r.asynchrony_p95 == 0 * kMs);
  CHECK(r.late_share == 0);
}
