// Tests of the limits on temperature and exposure: with any settings, operators, displays and reports.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/thermal_state_t.hpp>

#include "tests/thermal_node/support/limits_trial.h"

using namespace tactus;
using namespace tactus::thermal;
using test::LimitsTrial;
using test::TrialResult;
using test::TrueExposure;

namespace {

constexpr int kIce = 3;

std::vector<material_def_t> with_ice() {
  auto materials = kMaterials;
  materials.push_back(material(401, 8960, 385, -200));
  return materials;
}

// A long touch, without a reading of the display.
struct LongTouch {
  double warm_s = 0, cold_s = 0;  // longest time without a pause above 39 degC, below 20 degC
  TrueExposure exposure;
};

LongTouch hold(const Settings& settings, int material, double seconds) {
  Hand hand(with_ice(), settings);
  LongTouch result;
  double warm_s = 0, cold_s = 0;
  for (int i = 0; i < seconds * 50; ++i) {
    const double degC = hand.press(material, 20).commanded_degC;
    warm_s = degC > 39 ? warm_s + 0.02 : 0;
    cold_s = degC < 20 ? cold_s + 0.02 : 0;
    result.warm_s = std::max(result.warm_s, warm_s);
    result.cold_s = std::max(result.cold_s, cold_s);
    result.exposure.add(degC, 0.02, settings);
  }
  return result;
}

}  // namespace

TEST_CASE("No slew limit lengthens the time of warmth or cold") {
  Settings settings = bare();
  for (const double slew_K_s : {300.0, 20.0, 1.0, 0.1}) {
    INFO(slew_K_s << " K/s");
    settings.slew_max_K_s = slew_K_s;
    // 42 degC for 4 min is the dose of a minute at 43 degC.
    const LongTouch warm = hold(settings, kFurnace, 400), cold = hold(settings, kIce, 300);
    CHECK(warm.warm_s <= 240.02);
    CHECK(warm.warm_s > 200);
    CHECK(warm.exposure.dose_s <= 60);
    CHECK(cold.cold_s <= 60.02);
    CHECK(cold.cold_s > 50);
    CHECK(cold.exposure.cold_s <= 60);
  }
}

TEST_CASE("No slew limit delays the return to neutral when the input is lost") {
  for (const double slew_K_s : {300.0, 20.0, 0.1}) {
    Settings settings = bare();
    settings.slew_max_K_s = slew_K_s;
    Hand hand(kMaterials, settings);
    hand.renderer = Renderer(settings, kMaterials, 0, 9, 42.0);
    thermal_state_t state{};
    for (int i = 0; i < 25; ++i) {
      Tick tick = hand.next();
      tick.contact.status = sync::SampleStatus::kStale;
      state = hand.renderer.step(tick);
    }
    CHECK(state.commanded_degC == 33);
  }
}

TEST_CASE("A report that stays at rest while the plate is commanded to warmth does not lift the limits") {
  const bool limited = GENERATE(false, true);
  INFO((limited ? "the display reports that it is limited" : "the display reports that it follows"));
  constexpr int kSeconds = 900;
  const Settings settings = bare();
  Hand hand(kMaterials, settings);
  TrueExposure exposure;
  double warm_s = 0;
  thermal_state_t state{};
  const auto press = [&] {
    Tick tick = hand.next();
    touch(tick, kFurnace, 20);
    state = hand.renderer.step(tick, {.longest_substep_s = 0.02, .plate = PlateReading{33, 30, 0, 0, limited}});
  };
  for (int i = 0; i < 50 * kSeconds; ++i) {
    press();
    exposure.add(state.commanded_degC, 0.02, settings);
    REQUIRE(exposure.dose_s <= settings.dose_max_s);
    if (state.commanded_degC > 39) warm_s += 0.02;
  }
  if (limited) {
    // Near the plate for Following::kShort_s, then 2.5 s until it is short again.
    CHECK(warm_s < 0.25 * kSeconds);
    return;
  }
  CHECK(state.limited == 1);
  CHECK(hand.renderer.display() == DisplayState::kNotFollowing);
  CHECK(state.commanded_degC == 33);
  // From 33 degC a display may take 2 s to leave the tolerance, and half a second is allowed beyond that.
  CHECK(warm_s < 3);
  hand.renderer.restart_display();
  press();
  CHECK(hand.renderer.display() == DisplayState::kGood);
}

TEST_CASE("Warmth counts by the larger of command and reading, cold by the smaller") {
  Hand hand(kMaterials, bare());
  const auto dose_after = [&](double command_degC, double plate_degC) {
    hand.renderer = Renderer(bare(), kMaterials, 0, 9, command_degC);
    for (int i = 0; i < 50; ++i) {
      Tick tick = hand.next();
      touch(tick, kFurnace, 20);
      hand.renderer.step(tick, {.plate = PlateReading{plate_degC}});
    }
    return std::pair(hand.renderer.dwell().dose_s(), hand.renderer.dwell().cold_s());
  };
  CHECK(dose_after(42, 33).first == Approx(0.25).epsilon(0.02));
  CHECK(dose_after(33, 42).first == Approx(0.25).epsilon(0.02));
  CHECK(dose_after(33, 19).second == Approx(1).epsilon(0.02));
}

TEST_CASE("A lost display is commanded to rest at once, and is used again after a second") {
  Hand hand(kMaterials, bare());
  for (int i = 0; i < 50; ++i) hand.press(kFurnace, 20);
  const auto step = [&](bool lost) {
    Tick tick = hand.next();
    touch(tick, kFurnace, 20);
    return hand.renderer.step(tick, {.display_lost = lost}).commanded_degC;
  };
  for (int i = 0; i < 25; ++i) step(true);
  CHECK(step(true) == 33);
  for (int i = 0; i < 49; ++i) {
    CHECK(step(false) == 33);
    CHECK(hand.renderer.display() == DisplayState::kLost);
  }
  for (int i = 0; i < 3; ++i) step(false);
  CHECK(step(false) > 33);
}

TEST_CASE("After a gap of any length the command begins at rest, and the exposure is not forgotten") {
  const double gap_s = GENERATE(0.31, 10.0, 36000.0);
  Hand hand(kMaterials, bare());
  for (int i = 0; i < 50 * 100; ++i) hand.press(kFurnace, 20);
  const double dose_s = hand.renderer.dwell().dose_s();
  REQUIRE(dose_s > 20);
  Tick tick = hand.next(sync::from_seconds(gap_s));
  touch(tick, kFurnace, 20);
  CHECK(hand.renderer.step(tick).commanded_degC == 33);
  CHECK(hand.renderer.dwell().dose_s() >= dose_s);
  CHECK(hand.press(kFurnace, 20).commanded_degC <= 33.4f + 1e-4f);
}

TEST_CASE("A clock that jumps while the plate is neutral lets the exposure recover by a second at most") {
  Hand hand(kMaterials, bare());
  for (int i = 0; i < 50 * 100; ++i) hand.press(kFurnace, 20);
  for (int i = 0; i < 100; ++i) {
    Tick lost = hand.next();
    lost.contact.status = sync::SampleStatus::kStale;
    hand.renderer.step(lost);
  }
  const double dose_s = hand.renderer.dwell().dose_s();
  REQUIRE(dose_s > 20);
  hand.renderer.step(hand.next(sync::from_seconds(1e6)));
  CHECK(hand.renderer.dwell().dose_s() == Approx(dose_s * std::exp(-1 / Dwell::kDecay_s)));
}

TEST_CASE("No settings, operator, display or report passes a limit") {
  constexpr int kTrials = 2000;
  constexpr int kTicks = 300;
  constexpr double kSeconds = 40;
  int warm = 0, cold = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const TrialResult r = LimitsTrial(static_cast<std::uint64_t>(trial) + 1, kTicks, kSeconds).run();
    INFO("trial " << trial << ", device " << r.settings.device << ", slew " << r.settings.slew_max_K_s
                  << " K/s, rate " << r.settings.rate_Hz << " Hz, dose_max " << r.settings.dose_max_s
                  << " s, cold_max " << r.settings.cold_max_s << " s below " << r.settings.cold_below_degC
                  << " degC");
    REQUIRE(r.dose_share <= 1 + 1e-9);
    REQUIRE(r.cold_share <= 1 + 1e-9);
    REQUIRE(r.beyond_range_K <= 1e-5);
    REQUIRE(r.beyond_slew_K <= 1e-4);
    REQUIRE(r.late_neutral_K <= 1e-4);
    warm += r.dose_share > 0.5;
    cold += r.cold_share > 0.5;
  }
  // Enough of the trials come near a limit.
  CHECK(warm > kTrials / 25);
  CHECK(cold > kTrials / 25);
}
