#include "audio_node/signal/edge_fade.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using tactus::audio::EdgeFade;

namespace {

constexpr int kFade = 240;  // 5 ms at 48 kHz

std::vector<float> played(EdgeFade& edge, int frames) {
  std::vector<float> x(2 * static_cast<std::size_t>(frames), 0.8f);
  edge.apply(x.data(), frames, 2);
  return x;
}

float steepest(const std::vector<float>& x, float before) {
  float most = std::abs(x.front() - before);
  for (std::size_t i = 2; i < x.size(); i += 2) most = std::max(most, std::abs(x[i] - x[i - 2]));
  return most;
}

// A raised cosine over 240 samples changes by at most pi / 2 / 240 of its height a sample.
constexpr float kSteepest = 0.8f * 1.5708f / kFade * 1.01f;

}  // namespace

TEST_CASE("Sound that is neither interrupted nor ended is unchanged") {
  EdgeFade edge(48000);
  for (const float x : played(edge, 1000)) CHECK(x == 0.8f);
}

TEST_CASE("An interrupted sound begins at silence and returns within 5 ms without a step") {
  EdgeFade edge(48000);
  edge.restart();
  const auto x = played(edge, 400);
  CHECK(steepest(x, 0) < kSteepest);
  CHECK(x[2 * kFade] == 0.8f);
}

TEST_CASE("An ended sound falls to silence within 5 ms without a step, and stays silent") {
  EdgeFade edge(48000);
  edge.end();
  const auto x = played(edge, 400);
  CHECK(steepest(x, 0.8f) < kSteepest);
  CHECK(edge.ended());
  for (std::size_t i = 2 * kFade; i < x.size(); ++i) CHECK(x[i] == 0);
  edge.restart();
  for (const float y : played(edge, 400)) CHECK(y == 0);
}

TEST_CASE("A sound that ends while it returns falls from where it is") {
  EdgeFade edge(48000);
  edge.restart();
  const float last = played(edge, 100)[198];
  edge.end();
  const auto x = played(edge, 400);
  CHECK(steepest(x, last) < kSteepest);
  CHECK(x[2 * 100] == 0);
}
