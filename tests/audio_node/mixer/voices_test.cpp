#include "audio_node/mixer/voices.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/audio_node/support/bench.h"

using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

namespace {

constexpr double kFrequency_Hz = 1000, kDamping_1_s = 40;

// A body of one mode that is driven by a force, N s a sample.
struct Pushed {
  Resonators resonators;
  PerMode gains{};
  Voices voices{4, kRate, kRing};
  std::vector<double> left;

  Pushed() {
    const ModeStep step = mode_step(kFrequency_Hz, kDamping_1_s, kRate);
    resonators.add(step);
    gains[0] = step.unit_gain;
  }
  void play(const std::vector<float>& force, bool pushed = true) {
    for (std::size_t at = 0; at + kMaxBlock <= force.size(); at += kMaxBlock) {
      SourcePosition place;
      place.direction = Eigen::Vector3f::UnitY();
      if (pushed) voices.drive({3, &resonators, &gains, place, &force[at]});
      std::vector<float> mix(2 * kMaxBlock);
      voices.render(mix.data(), kMaxBlock);
      for (std::size_t n = 0; n < kMaxBlock; ++n) left.push_back(static_cast<double>(mix[2 * n]));
    }
  }
  double amplitude(std::size_t from) const {
    return *std::max_element(left.begin() + static_cast<std::ptrdiff_t>(from), left.end());
  }
};

std::vector<float> sine(double frequency_Hz, int frames) {
  std::vector<float> f;
  for (int n = 0; n < frames; ++n)
    f.push_back(0.001f * static_cast<float>(std::sin(2 * pi * frequency_Hz * n / kRate)));
  return f;
}

// Velocity of a driven oscillator per unit of force: w / |w0^2 + d^2 - w^2 + 2 i d w| (w0: its ringing frequency).
double response(double frequency_Hz) {
  const double w0 = 2 * pi * kFrequency_Hz, w = 2 * pi * frequency_Hz, d = kDamping_1_s;
  return w / std::hypot(w0 * w0 + d * d - w * w, 2 * d * w);
}

}  // namespace

TEST_CASE("A driven body responds as a damped oscillator at, below and above its frequency") {
  const int frames = 48000 / kMaxBlock * kMaxBlock;
  for (const double f : {500.0, 950.0, 1000.0, 1050.0, 2000.0}) {
    CAPTURE(f);
    Pushed body;
    body.play(sine(f, frames));
    // The transient has decayed by e^(-40 / 2). The oracle is continuous; steps of 1 / 48000 s change the response
    // off resonance by (w T)^2 / 12, 0.6 % at 2 kHz, and a sample may miss the crest by the same amount.
    CHECK(body.amplitude(24000) == Approx(0.001 * kRate * response(f)).epsilon(0.02));
  }
}

TEST_CASE("The forces of two contacts of one body add up") {
  Pushed once, twice;
  const auto force = sine(1000, 4800 / kMaxBlock * kMaxBlock);
  once.play(force);
  for (std::size_t at = 0; at + kMaxBlock <= force.size(); at += kMaxBlock) {
    SourcePosition place;
    place.direction = Eigen::Vector3f::UnitY();
    for (int i = 0; i < 2; ++i) twice.voices.drive({3, &twice.resonators, &twice.gains, place, &force[at]});
    std::vector<float> mix(2 * kMaxBlock);
    twice.voices.render(mix.data(), kMaxBlock);
    for (std::size_t n = 0; n < kMaxBlock; ++n) twice.left.push_back(static_cast<double>(mix[2 * n]));
  }
  CHECK(twice.voices.active() == 1);
  for (std::size_t n = 0; n < once.left.size(); ++n)
    REQUIRE(twice.left[n] == Approx(2 * once.left[n]).epsilon(1e-4).margin(1e-6));  // single precision
}

TEST_CASE("A body without a force rings down and frees its voice") {
  Pushed body;
  body.play(sine(1000, 9600 / kMaxBlock * kMaxBlock));
  CHECK(body.voices.active() == 1);
  // By e^(-40 t) from 0.6 below -100 dBFS: 0.28 s.
  body.play(std::vector<float>(19200), false);
  CHECK(body.voices.active() == 0);
  CHECK(body.left.back() == 0);
  SECTION("a body at rest under zero force makes no sound") {
    Pushed still;
    still.play(std::vector<float>(4800));
    for (const double x : still.left) REQUIRE(x == 0);
  }
}

TEST_CASE("A driven body keeps its voice when louder bodies use all voices") {
  Voices voices(4, kRate, kRing);
  for (int i = 0; i < 4; ++i)
    voices.strike(strike_of(0, i, 300 + 50 * i, 0.5, 0, 0.5f).sides[0], 1, one_hump(1), 0);
  Pushed quiet;
  const auto force = sine(1000, 48000 / kMaxBlock * kMaxBlock);
  double most = 0;
  for (std::size_t at = 0; at + kMaxBlock <= force.size(); at += kMaxBlock) {
    std::vector<float> block(force.begin() + static_cast<std::ptrdiff_t>(at),
                             force.begin() + static_cast<std::ptrdiff_t>(at + kMaxBlock));
    for (std::int64_t id : {10, 11}) voices.drive({id, &quiet.resonators, &quiet.gains, {}, block.data()});
    std::vector<float> mix(2 * kMaxBlock);
    voices.render(mix.data(), kMaxBlock);
    if (at > 24000) most = std::max<double>(most, voices.active());
  }
  // Two of the loud ones were replaced, and none after that.
  CHECK(most == 4);
}

TEST_CASE("Contacts of one body beyond the maximum number leave its sound finite") {
  Pushed body;
  const std::vector<float> force(kMaxBlock, 1e-6f);
  for (int i = 0; i < 3 * Voices::kDrives; ++i)
    body.voices.drive({3, &body.resonators, &body.gains, {}, force.data()});
  std::vector<float> mix(2 * kMaxBlock);
  body.voices.render(mix.data(), kMaxBlock);
  for (const float x : mix) CHECK(std::isfinite(x));
  CHECK(body.voices.active() == 1);
}

TEST_CASE("Eighty simultaneous blows on one body act as eighty single blows") {
  const auto blow = [](std::int64_t voice, int i) {
    StrikeSide side = strike_of(0, voice, 40, 5, 0, 0.01f * (1 + static_cast<float>(i % 7))).sides[0];
    side.click = 0.3f * side.impulse;
    return side;
  };
  Voices one(8, kRate, kRing), many(8, kRate, kRing);
  std::vector<float> of_one, of_many;
  // One begins every 11 samples and lasts for 1500: in the end all of them push. The last is one too many.
  for (int i = 0, block = 0; block < 60; ++block) {
    for (; i < 81 && 11 * i < (block + 1) * kMaxBlock; ++i) {
      one.strike(blow(0, i), 1, one_hump(1500), 11 * i - block * kMaxBlock);
      if (i < 80) many.strike(blow(i / 16, i), 1, one_hump(1500), 11 * i - block * kMaxBlock);
    }
    for (auto [voices, output] : {std::pair(&one, &of_one), std::pair(&many, &of_many)}) {
      std::vector<float> mix(2 * kMaxBlock);
      voices->render(mix.data(), kMaxBlock);
      for (std::size_t n = 0; n < kMaxBlock; ++n) output->push_back(mix[2 * n]);
    }
  }
  float most = 0, off = 0;
  for (std::size_t n = 0; n < of_one.size(); ++n)
    most = std::max(most, std::abs(of_many[n])), off = std::max(off, std::abs(of_one[n] - of_many[n]));
  CAPTURE(most, off);
  REQUIRE(most > 0.1f);
  CHECK(off < 1e-5f * most);  // single precision
}
