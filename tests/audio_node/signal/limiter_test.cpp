#include "audio_node/signal/limiter.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using tactus::audio::Limiter;

namespace {

constexpr double kRate_Hz = 48000;

// Frames of two channels: the sound, and a small constant. One gain acts on both, so the second channel shows it.
// Returns the largest sample of the first channel before the final clamp, as a share of the ceiling: above 1 it was
// clipped.
double highest_before_clamp(const std::vector<float>& sound, float ceiling) {
  constexpr float kPilot = 0x1p-10f;  // a power of two: the gain is exact
  std::vector<float> x;
  for (const float s : sound) x.insert(x.end(), {s, kPilot});
  Limiter limiter(static_cast<double>(ceiling), kRate_Hz);
  const int frames = static_cast<int>(sound.size());
  for (int done = 0; done < frames; done += 77) limiter.process(x.data() + 2 * done, std::min(77, frames - done));
  double highest = 0;
  for (std::size_t n = Limiter::kDelay; n < sound.size(); ++n) {
    const double gain = static_cast<double>(x[2 * n + 1] / kPilot);
    highest = std::max(highest, gain * std::abs(static_cast<double>(sound[n - Limiter::kDelay])));
  }
  return highest / static_cast<double>(ceiling);
}

// Rounding of the mean of 64 gains and of the product, each to a float.
constexpr double kUnclipped = 1 + 4e-7;

}  // namespace

TEST_CASE("The limiter keeps every sample within its ceiling for any input") {
  const float worst[] = {1e38f,
                         -1e38f,
                         std::numeric_limits<float>::quiet_NaN(),
                         std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity(),
                         std::numeric_limits<float>::denorm_min(),
                         0.f,
                         0.9f};
  std::mt19937 random(1);
  Limiter limiter(0.9, 48000);
  bool within = true;
  for (int block = 0; block < 4000; ++block) {
    std::vector<float> x(2 * (1 + random() % 200));
    for (float& s : x) {
      switch (random() % 4) {
        case 0: s = worst[random() % 8]; break;
        case 1: s = static_cast<float>(static_cast<double>(random()) / 4e9 * 100 - 50); break;
        case 2: s = (random() & 1) ? 30.f : -30.f; break;
        default: s = 0.1f;
      }
    }
    limiter.process(x.data(), static_cast<int>(x.size() / 2));
    for (const float s : x) within &= std::abs(s) <= 0.9f;  // false for NaN
  }
  CHECK(within);
}

TEST_CASE("Below the ceiling the limiter is an exact delay") {
  Limiter limiter(0.9, 48000);
  std::mt19937 random(2);
  std::vector<float> in(2 * 5000);
  for (float& s : in) s = static_cast<float>(random() % 1700) / 1000.f - 0.85f;
  std::vector<float> out = in;
  limiter.process(out.data(), 5000);
  bool same = true;
  for (std::size_t n = Limiter::kDelay; n < 5000; ++n)
    for (std::size_t c = 0; c < 2; ++c) same &= out[2 * n + c] == in[2 * (n - Limiter::kDelay) + c];
  CHECK(same);
}

TEST_CASE("A loud sample is reduced by a ramp before it, not clipped") {
  Limiter limiter(0.5, 48000);
  std::vector<float> x(2 * 400, 0.4f);
  x[2 * 200] = 2.f;
  limiter.process(x.data(), 400);
  const std::size_t loud = 200 + Limiter::kDelay;
  CHECK(x[2 * loud] == Approx(0.5f).epsilon(1e-3));
  // The gain falls from 1 to 1/4 in 64 steps: no step of a steady tone is larger than 0.75 / 64 of it.
  for (std::size_t n = loud - 100; n < loud - 1; ++n)
    CHECK(std::abs(x[2 * n + 3] - x[2 * n + 1]) <= 0.4f * 0.75f / 64 + 1e-6f);
}

TEST_CASE("Tones from 10 Hz to 20 kHz are reduced without clipping, at any level") {
  for (const double frequency_Hz : {10., 15., 20., 25., 31.5, 40., 63., 100., 250., 1000., 4000., 11025., 20000.})
    for (const double level : {1.01, 2., 10., 1000.}) {
      std::vector<float> sound;
      for (int n = 0; n < 24000; ++n)
        sound.push_back(static_cast<float>(level * std::sin(2 * std::numbers::pi * frequency_Hz * n / kRate_Hz)));
      CAPTURE(frequency_Hz, level);
      CHECK(highest_before_clamp(sound, 0.9f) <= kUnclipped);
    }
}

TEST_CASE("Steps, slopes and random signals are reduced without clipping") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<float> sound;
    float level = 1, slope = 0;
    const int kind = trial % 4;
    while (sound.size() < 12000) {
      if (random() % 200 == 0) level = std::pow(10.f, 3 * any(random)), slope = level * any(random) / 300;
      level += slope;
      sound.push_back(kind == 0   ? level                             // steps and slopes, of any length
                      : kind == 1 ? level * any(random)               // noise in bursts
                      : kind == 2 ? (random() % 2 ? level : -level)   // extremes only
                                  : 10 * (1 - static_cast<float>(sound.size() % 400) / 400));  // falling ramps
    }
    CAPTURE(trial);
    CHECK(highest_before_clamp(sound, 0.9f) <= kUnclipped);
  }
}
