#include "audio_node/signal/dropout.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

constexpr DropoutDef kTwenty_ms{0.02, 1};
constexpr std::size_t kSecondSamples = 48000, kLength = 960, kEdge = 48;
// Of a raised cosine over the edge.
const float kEdgeStep = std::numbers::pi_v<float> / 2 / kEdge + 1e-5f;

std::vector<float> next(Dropout& dropout, std::size_t samples) {
  std::vector<float> gains(samples);
  dropout.next(gains);
  return gains;
}

float largest_step(const std::vector<float>& x) {
  float most = 0;
  for (std::size_t i = 1; i < x.size(); ++i) most = std::max(most, std::abs(x[i] - x[i - 1]));
  return most;
}

// A lasting tone, with or without drop-outs.
struct Tone {
  explicit Tone(const DropoutDef& dropout) { set_dropout(dropout); }
  void set_dropout(const DropoutDef& dropout) { REQUIRE(bench->queues.commands.push(RenderCommand{dropout, 0})); }
  void play_until(std::size_t samples) {
    while (bench->left.size() < samples) bench->play(128);
  }
  std::unique_ptr<Bench> bench = std::make_unique<Bench>();
};

}  // namespace

TEST_CASE("A drop-out is silent for its length at its period, with edges of a millisecond") {
  Dropout dropout(kRate);
  dropout.set(kTwenty_ms);
  const auto gains = next(dropout, 10 * kSecondSamples);
  double lost = 0;
  for (std::size_t n = 0; n < gains.size(); ++n) {
    const std::size_t since = n % kSecondSamples;
    if (since + 1 >= kEdge && since < kLength) CHECK(gains[n] == 0);
    if (since >= kLength + kEdge) CHECK(gains[n] == 1);
    lost += 1 - static_cast<double>(gains[n]);
  }
  // The second edge removes the amount that the first one passes.
  CHECK(lost == Approx(10 * kLength).epsilon(1e-6));
  CHECK(largest_step(gains) <= kEdgeStep);
}

TEST_CASE("Drop-outs depend on the sample number only, not on the block sizes") {
  Dropout whole(kRate), cut(kRate);
  whole.set(kTwenty_ms), cut.set(kTwenty_ms);
  std::vector<float> parts;
  for (std::size_t size = 1; parts.size() < kSecondSamples; size = size % 64 + 1)
    for (const float gain : next(cut, size)) parts.push_back(gain);
  CHECK(parts == next(whole, parts.size()));
}

TEST_CASE("Drop-outs are switched on and off without a click and keep their positions") {
  Dropout dropout(kRate), always(kRate);
  always.set(kTwenty_ms);
  std::vector<float> gains;
  const auto play = [&](std::size_t samples) {
    for (const float gain : next(dropout, samples)) gains.push_back(gain);
  };
  play(400);
  dropout.set(kTwenty_ms);  // in the middle of its silence
  play(100);
  CHECK(gains.back() == 0);
  dropout.set({});
  play(kEdge);
  CHECK(gains.back() == 1);
  play(1000);
  dropout.set(kTwenty_ms);
  play(kSecondSamples);
  CHECK(largest_step(gains) <= kEdgeStep);
  const auto reference = next(always, gains.size());
  CHECK(std::equal(gains.begin() + 1600, gains.end(), reference.begin() + 1600));
}

TEST_CASE("Sound with drop-outs equals the sound without, times the drop-out gains, to the bit") {
  Tone plain({}), poor(kTwenty_ms);
  for (Tone* t : {&plain, &poor}) {
    REQUIRE(t->bench->queues.strikes.push(strike_of(1, 1, 440, 0.5, t->bench->time_ns(3000))));
    t->play_until(2 * kSecondSamples);
  }
  Dropout dropout(kRate);
  dropout.set(kTwenty_ms);
  const auto gains = next(dropout, 2 * kSecondSamples);
  const auto &x = plain.bench->left, &y = poor.bench->left;
  double loudest = 0;
  for (std::size_t n = Limiter::kDelay; n < 2 * kSecondSamples; ++n) {
    const float expected = x[n] * gains[n - Limiter::kDelay];
    CHECK(y[n] == expected);
    loudest = std::max(loudest, std::abs(static_cast<double>(y[n])));
  }
  CHECK(loudest > 0.05);
}

TEST_CASE("A strike whose onset is in a drop-out is reported as dropped by the profile") {
  // Frames leave the limiter kDelay samples after they were counted.
  const auto struck_at = [](std::size_t counted) {
    Tone tone(kTwenty_ms);
    tone.play_until(kSecondSamples / 2);
    const auto at = tone.bench->time_ns(kSecondSamples + counted + Limiter::kDelay);
    REQUIRE(tone.bench->queues.strikes.push(strike_of(1, 1, 440, 0.5, at)));
    tone.play_until(kSecondSamples + kSecondSamples / 2);
    REQUIRE(tone.bench->reports.size() == 1);
    const auto& left = tone.bench->left;
    const bool rings_after =
        std::any_of(left.begin() + kSecondSamples + 2000, left.end(), [](float x) { return std::abs(x) > 0.01f; });
    CHECK(rings_after);
    return tone.bench->reports[0];
  };
  for (const std::size_t counted : {kEdge, kLength / 2, kLength}) {
    const presentation_t r = struck_at(counted);
    CHECK(r.outcome == presentation_t::DROPPED_BY_PROFILE);
    CHECK(r.presented_ns == -1);
  }
  CHECK(struck_at(0).outcome == presentation_t::PRESENTED);
  CHECK(struck_at(kLength + kEdge).outcome == presentation_t::PRESENTED);
}

TEST_CASE("Drop-outs can start and end while a sound plays") {
  Tone tone({});
  REQUIRE(tone.bench->queues.strikes.push(strike_of(1, 1, 440, 0.5, tone.bench->time_ns(3000))));
  tone.play_until(kSecondSamples / 2);
  tone.set_dropout({0.02, 0.1});
  tone.play_until(kSecondSamples);
  tone.set_dropout({});
  tone.play_until(2 * kSecondSamples);
  const auto silent = [&](std::size_t from, std::size_t to) {
    long run = 0, longest = 0;
    for (std::size_t n = from; n < to; ++n)
      longest = std::max(longest, run = tone.bench->left[n] == 0 ? run + 1 : 0);
    return longest;
  };
  CHECK(silent(4000, kSecondSamples / 2) < 10);
  CHECK(silent(kSecondSamples / 2, kSecondSamples) == kLength - kEdge + 1);
  CHECK(silent(kSecondSamples + kLength, 2 * kSecondSamples) < 10);
  // The tone moves by 0.1 * 2 pi 440 / 48000 a sample, and its edge by 0.1 times the steepest.
  CHECK(largest_step({tone.bench->left.begin() + 4000, tone.bench->left.end()}) < 0.1f * (0.0576f + kEdgeStep));
}
