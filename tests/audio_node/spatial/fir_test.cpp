#include "audio_node/spatial/fir.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace tactus::audio;

TEST_CASE("Both filters give what the sum of their products gives, with all instructions of this machine") {
  const int taps = GENERATE(16, 128, 272);
  std::vector<float> input(static_cast<std::size_t>(taps + kMaxBlock)), left, right;
  for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<float>(std::sin(0.7 * i * i));
  for (int k = 0; k < taps; ++k)
    left.push_back(static_cast<float>(std::cos(1.3 * k * k))), right.push_back(static_cast<float>(std::sin(k)));
  for (const Instructions i : available_instructions()) {
    INFO(name(i));
    float l[kMaxBlock], r[kMaxBlock];
    fir_pair(i)(input.data() + taps, left.data(), right.data(), taps, l, r);
    for (int n = 0; n < kMaxBlock; ++n) {
      double a = 0, b = 0;
      for (int k = 0; k < taps; ++k) {
        const auto x = static_cast<double>(input[static_cast<std::size_t>(taps + n - k)]);
        a += x * static_cast<double>(left[static_cast<std::size_t>(k)]);
        b += x * static_cast<double>(right[static_cast<std::size_t>(k)]);
      }
      // Each of the products and sums rounds by 2^-24 of at most taps.
      const double most = taps * taps * std::pow(2, -24);
      CHECK(std::abs(static_cast<double>(l[n]) - a) < most);
      CHECK(std::abs(static_cast<double>(r[n]) - b) < most);
    }
  }
}
