#include "audio_node/samples/layers.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tactus::audio;

namespace {

Layers three() {
  Layers l;
  for (const double v : {0.1, 0.4, 1.6}) l.by_speed.push_back({v, 1, {Recording{}}});
  return l;
}

}  // namespace

TEST_CASE("Layers crossfade by the logarithm of the speed with constant power") {
  const Layers l = three();
  // Halfway on a logarithmic scale: equal strength, -3 dB each.
  const LayerMix half = mix_of(l, 0.2);
  CHECK(half.layer[0] == 0);
  CHECK(half.layer[1] == 1);
  CHECK(half.gain[0] == Approx(std::sqrt(0.5)));
  CHECK(half.gain[1] == Approx(std::sqrt(0.5)));
  for (double v = 0.02; v < 4; v *= 1.1) {
    const LayerMix m = mix_of(l, v);
    CHECK(m.gain[0] * m.gain[0] + m.gain[1] * m.gain[1] == Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("Below the slowest and above the fastest speed one layer is played alone") {
  const Layers l = three();
  CHECK(mix_of(l, 1e-6).layer == std::array{0, -1});
  CHECK(mix_of(l, 50).layer == std::array{2, -1});
  CHECK(mix_of(Layers{}, 1).layer == std::array{-1, -1});
}

TEST_CASE("Takes are selected by the number of the event, reproducibly and evenly") {
  Layer layer;
  layer.takes.resize(4);
  std::array<int, 4> count{};
  for (std::int64_t id = 0; id < 4000; ++id) {
    const auto i = &select_take(layer, id) - layer.takes.data();
    CHECK(&select_take(layer, id) == &layer.takes[static_cast<std::size_t>(i)]);
    ++count[static_cast<std::size_t>(i)];
  }
  // The standard deviation of 4000 draws of 1/4 is 27: within 5 of them.
  for (const int n : count) CHECK(std::abs(n - 1000) < 137);
}
