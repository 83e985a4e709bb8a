#include "audio_node/spatial/delay.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus::audio;

namespace {

constexpr int kPast = 64, kFrames = 64;

std::vector<float> tone(double per_frame) {
  std::vector<float> x;
  for (int n = -kPast; n < kFrames; ++n) x.push_back(static_cast<float>(std::sin(per_frame * n)));
  return x;
}

}  // namespace

TEST_CASE("A fractional delay agrees with the polynomial through the samples") {
  const float delay = GENERATE(2.f, 2.25f, 2.5f, 7.f, 31.4f);
  const double w = 2 * std::numbers::pi * 3000 / 48000;
  const auto x = tone(w);
  float out[kFrames] = {};
  add_delayed(x.data() + kPast, delay, delay, kFrames, out);
  // The remainder of the polynomial through 6 samples is at most (w^6 / 6!) (1/2 3/2 5/2)^2 of the tone: 2.9e-5.
  for (int n = 0; n < kFrames; ++n)
    CHECK(std::abs(static_cast<double>(out[n]) - std::sin(w * (n - static_cast<double>(delay)))) < 3e-5);
}

TEST_CASE("A changing delay moves linearly from one value to the other") {
  const float from = GENERATE(2.f, 20.f), to = GENERATE(2.f, 3.3f, 25.f);
  const double w = 2 * std::numbers::pi * 3000 / 48000;
  const auto x = tone(w);
  float out[kFrames] = {};
  add_delayed(x.data() + kPast, from, to, kFrames, out);
  for (int n = 0; n < kFrames; ++n) {
    const double delay = static_cast<double>(from) + static_cast<double>(to - from) * (n + 1) / kFrames;
    CHECK(std::abs(static_cast<double>(out[n]) - std::sin(w * (n - delay))) < 3e-5);
  }
}

TEST_CASE("A delay reads only the available frames, one more, and the required past") {
  const float from = GENERATE(2.f, 2.3f, 9.f), to = GENERATE(2.f, 9.f, 8.5f);
  const int past = static_cast<int>(std::ceil(std::max(from, to))) + kDelayReach;
  // NaN in every place that must not be read: with any weight it would be audible.
  std::vector<float> x(static_cast<std::size_t>(past + kFrames + 1), 1.f);
  x.insert(x.begin(), 8, NAN);
  x.insert(x.end(), 8, NAN);
  float out[kFrames] = {};
  add_delayed(x.data() + 8 + past, from, to, kFrames, out);
  for (const float y : out) CHECK(y == Approx(1));
}
