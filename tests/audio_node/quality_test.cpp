#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

constexpr int kPeriod = 128;
constexpr std::size_t kFade = 240;  // 5 ms

// A body of `modes` modes, 200 Hz apart; with a quarter of them the lowest group of four sounds.
StrikeSide body(std::int64_t voice, int modes, float impulse) {
  StrikeSide side = strike_of(0, voice, 200, 2, 0, impulse).sides[0];
  Resonators resonators;
  for (int i = 0; i < modes; ++i) {
    const ModeStep step = mode_step(200 * (i + 1), 2, kRate);
    resonators.add(step);
    side.gains[static_cast<std::size_t>(i)] = step.unit_gain / static_cast<float>(i + 1);
  }
  side.resonators = kept(resonators);
  return side;
}

struct Sounding {
  Voices voices;
  std::vector<float> left = {};

  void render(int blocks) {
    for (int b = 0; b < blocks; ++b) {
      std::vector<float> mix(2 * kMaxBlock);
      voices.render(mix.data(), kMaxBlock);
      for (std::size_t n = 0; n < kMaxBlock; ++n) left.push_back(mix[2 * n]);
    }
  }
  float largest_step(std::size_t from) const {
    float most = 0;
    for (std::size_t n = from; n < left.size(); ++n) most = std::max(most, std::abs(left[n] - left[n - 1]));
    return most;
  }
};

// Blocks take a share of their duration that each step of quality halves.
int run(Bench& bench, double share, int blocks) {
  for (int b = 0; b < blocks; ++b) {
    const double time_s = kPeriod / kRate;
    bench.used = sync::from_seconds(share * time_s / std::pow(2, bench.queues.quality.load()));
    bench.play(kPeriod);
  }
  return bench.queues.quality.load();
}

constexpr int kTwoSeconds = static_cast<int>(2 * kRate) / kPeriod;

}  // namespace

TEST_CASE("The quality falls when blocks take half of their time, and rises again after a calm period") {
  auto bench = std::make_unique<Bench>();
  CHECK(run(*bench, 0.4, kTwoSeconds) == 0);
  CHECK(run(*bench, 0.7, kTwoSeconds / 2) == 1);
  CHECK(run(*bench, 1.5, kTwoSeconds / 2) == 2);
  CHECK(run(*bench, 0.3, kTwoSeconds / 2) == 2);
  CHECK(run(*bench, 0.3, 10 * kTwoSeconds) == 0);
}

TEST_CASE("A fixed quality ignores the block times") {
  auto bench = std::make_unique<Bench>();
  REQUIRE(bench->queues.commands.push(RenderCommand{{}, 1}));
  CHECK(run(*bench, 3, 100) == 1);
  CHECK(run(*bench, 0.01, 10 * kTwoSeconds) == 1);
  REQUIRE(bench->queues.commands.push(RenderCommand{{}, -1}));
  run(*bench, 0.3, 1);
  CHECK(bench->queues.quality.load() == 0);
}

TEST_CASE("With fewer modes the lowest are unchanged, and the others fade") {
  Sounding full{Voices(4, kRate, kRing)}, less{Voices(4, kRate, kRing)};
  Sounding low{Voices(4, kRate, kRing)};  // only the lowest 16 of 64
  full.voices.strike(body(1, 64, 0.1f), 1, one_hump(20), 0);
  less.voices.strike(body(1, 64, 0.1f), 1, one_hump(20), 0);
  low.voices.strike(body(1, 16, 0.1f), 1, one_hump(20), 0);
  for (Sounding* s : {&full, &less, &low}) s->render(20);
  CHECK(less.left == full.left);
  less.voices.set_limits({4, 4});
  for (Sounding* s : {&full, &less, &low}) s->render(20);
  // The sums are of the same modes in the same order: equal to the bit once the rest has faded.
  CHECK(std::equal(less.left.begin() + 20 * kMaxBlock + kFade, less.left.end(),
                   low.left.begin() + 20 * kMaxBlock + kFade));
  CHECK(less.left.back() != full.left.back());
  // No step is larger than those of the sound itself and of its fading part: sum of 0.1 / k over 5 ms.
  const float own = full.largest_step(20 * kMaxBlock);
  CHECK(less.largest_step(20 * kMaxBlock) <= own + 0.1f * 4 / kFade);
}

TEST_CASE("Removed modes return with the next strike without a click") {
  Sounding s{Voices(4, kRate, kRing)}, low{Voices(4, kRate, kRing)}, fresh{Voices(4, kRate, kRing)},
      fresh_low{Voices(4, kRate, kRing)};
  s.voices.set_limits({4, 4});
  s.voices.strike(body(1, 64, 0.1f), 1, one_hump(20), 0);
  low.voices.strike(body(1, 16, 0.1f), 1, one_hump(20), 0);
  s.render(20), low.render(20);
  s.voices.set_limits({4, 1});
  s.render(20), low.render(20);
  CHECK(s.left == low.left);
  for (Sounding* one : {&s, &fresh}) one->voices.strike(body(1, 64, 0.1f), 1, one_hump(20), 0), one->render(1);
  for (Sounding* one : {&low, &fresh_low})
    one->voices.strike(body(1, 16, 0.1f), 1, one_hump(20), 0), one->render(1);
  const double upper = fresh.voices.energy() - fresh_low.voices.energy();
  REQUIRE(upper > 0);
  CHECK(s.voices.energy() - low.voices.energy() == Approx(upper).epsilon(1e-3));
}

TEST_CASE("With too many voices the quietest fade, and the others continue") {
  const std::vector<float> impulses{0.04f, 0.01f, 0.03f, 0.02f, 0.05f};
  Sounding s{Voices(5, kRate, kRing)}, loud{Voices(5, kRate, kRing)};
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    const StrikeSide side =
        strike_of(0, static_cast<std::int64_t>(i), 200 + 31 * static_cast<double>(i), 2, 0, impulses[i]).sides[0];
    s.voices.strike(side, 1, one_hump(1), 0);
    if (impulses[i] > 0.025f) loud.voices.strike(side, 1, one_hump(1), 0);
  }
  s.render(10), loud.render(10);
  CHECK(s.voices.active() == 5);
  s.voices.set_limits({3, 1});
  s.render(10), loud.render(10);
  CHECK(s.voices.active() == 3);
  for (std::size_t n = 10 * kMaxBlock + kFade; n < s.left.size(); ++n) CHECK(s.left[n] == loud.left[n]);
  // Each moves by 2 pi f / rate of its amplitude a sample, of 0.15 in total, at 324 Hz at most; 0.03 of it fades.
  CHECK(s.largest_step(10 * kMaxBlock) < 0.15f * 0.0425f + 0.03f / kFade);
}

TEST_CASE("A strike that finds all voices in use takes the quietest, which fades") {
  Sounding s{Voices(2, kRate, kRing)};
  s.voices.strike(strike_of(0, 1, 300, 2, 0, 0.1f).sides[0], 1, one_hump(1), 0);
  s.voices.strike(strike_of(0, 2, 200, 2, 0, 0.05f).sides[0], 1, one_hump(1), 0);
  s.render(10);
  // A long pulse, so that it is not a jump itself: slower than its own period it leaves little.
  s.voices.strike(strike_of(0, 3, 250, 2, 0, 0.1f).sides[0], 1, one_hump(48), 0);
  CHECK(s.voices.active() == 3);
  s.render(10);
  CHECK(s.voices.active() == 2);
  // 0.1 at 300 Hz, 0.05 at 200 Hz which fades, and 0.1 within half of 48 samples.
  const float most = 0.1f * 0.0393f + 0.05f * 0.0262f + 0.05f / kFade + 0.1f * 2 / 48 + 0.1f * 0.0327f;
  CHECK(s.largest_step(10 * kMaxBlock) < most);
}

TEST_CASE("With any number of simultaneous strikes the newest sound, and the number of voices stays limited") {
  Sounding s{Voices(4, kRate, kRing)};
  for (int i = 0; i < 500; ++i) s.voices.strike(strike_of(0, i, 300, 2, 0, 1e-3f).sides[0], 1, one_hump(1), 0);
  s.render(1);
  CHECK(s.voices.active() <= 4 + 16);
  s.render(10);
  CHECK(s.voices.active() == 4);
}
