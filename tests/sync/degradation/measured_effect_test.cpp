// Tests of the measured effect of a profile: its figures and its text.
#include "sync/degradation/measured_effect.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tactus::sync;

namespace {

DecisionRecord record(int ms, DropReason why, int held_ms = 0, bool is_event = true, std::uint64_t stream = 0) {
  DecisionRecord r{static_cast<std::uint64_t>(ms), is_event, sim_time(ms * 1'000'000ll), {}, host_time(ms * 1'000'000ll), stream};
  r.decision.why = why;
  r.decision.evaluated = true;
  r.decision.release = r.arrival + Nanoseconds(held_ms * 1'000'000ll);
  return r;
}

}  // namespace

TEST_CASE("Nothing decided has no text") { CHECK(MeasuredEffect().text().empty()); }

TEST_CASE("Mean, deviation, losses and bursts are those of the decisions") {
  MeasuredEffect effect;
  for (const int held_ms : {38, 42}) effect.add(record(held_ms, DropReason::kKept, held_ms), Nanoseconds(0));
  for (const int ms : {50, 51, 53}) effect.add(record(ms, DropReason::kLoss), Nanoseconds(0));
  effect.add(record(54, DropReason::kKept, 40), Nanoseconds(0));
  effect.add(record(55, DropReason::kLoss), Nanoseconds(0));
  const EffectFigures f = effect.events();
  CHECK(f.items == 7);
  CHECK(f.delivered == 3);
  CHECK(f.lost == 4);
  CHECK(f.bursts == 2);
  CHECK(f.mean_burst() == 2);
  CHECK(f.mean_delay_s == Approx(0.040));
  CHECK(f.sd_delay_s == Approx(0.002 * std::sqrt(2.0 / 3)));
  CHECK(effect.snapshots().items == 0);
  CHECK(effect.text() == "events +40.0 ms (sd 1.6), 57.1 % lost in bursts of 2.0");
}

TEST_CASE("A presentation delay and a shift count as delay") {
  MeasuredEffect effect;
  DecisionRecord early = record(10, DropReason::kKept);
  early.decision.shift = Nanoseconds(-3'000'000);
  effect.add(early, Nanoseconds(40'000'000));
  CHECK(effect.events().mean_delay_s == Approx(0.037));
}

TEST_CASE("The bursts and the rate of each stream are its own") {
  MeasuredEffect effect;
  for (int i = 0; i < 100; ++i) {
    effect.add(record(10 * i, i % 2 ? DropReason::kLoss : DropReason::kKept, 0, false, 1), Nanoseconds(0));
    effect.add(record(10 * i, DropReason::kLoss, 0, false, 2), Nanoseconds(0));
  }
  const EffectFigures f = effect.snapshots();
  CHECK(f.lost == 150);
  CHECK(f.bursts == 51);
  CHECK(f.rate_Hz == Approx(50));
}

TEST_CASE("An overtaken snapshot is no longer delivered") {
  MeasuredEffect effect;
  for (const int ms : {10, 20, 30}) effect.add(record(ms, DropReason::kKept, ms, false, 1), Nanoseconds(0));
  effect.add(record(30, DropReason::kOvertaken, 30, false, 1), Nanoseconds(0));
  const EffectFigures f = effect.snapshots();
  CHECK(f.items == 3);
  CHECK(f.delivered == 2);
  CHECK(f.overtaken == 1);
  CHECK(f.mean_delay_s == Approx(0.015));
  CHECK_THAT(effect.text(), Catch::Contains("33.3 % overtaken"));
}

TEST_CASE("The text of the effect is short and is found in the text of a health report") {
  MeasuredEffect effect;
  for (int ms = 0; ms < 2000; ++ms)
    for (const bool is_event : {true, false}) {
      DecisionRecord r = record(ms, ms % 3 ? DropReason::kKept : DropReason::kLoss, 10'000 + ms, is_event, 1);
      r.decision.duplicated = ms % 2;
      effect.add(r, Nanoseconds(0));
    }
  effect.set_wire(1000, 333);
  CHECK(effect.text().size() <= MeasuredEffect::kMaxText);
  const std::string status = "SCHED_FIFO 60, memory locked" + std::string(kEffectPrefix) + effect.text();
  CHECK(without_effect(status) == "SCHED_FIFO 60, memory locked");
  CHECK(effect_in(status) == effect.text());
  CHECK(without_effect("waiting") == "waiting");
  CHECK(effect_in("waiting").empty());
}
