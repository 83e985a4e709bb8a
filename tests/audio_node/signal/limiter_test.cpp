#include "audio_node/signal/limiter.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using tactus::audio::Limiter;

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
