#include "audio_node/spatial/fir.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace tactus::audio;

TEST_CASE("Each filter gives the sum of its products, with all instructions of this machine") {
  const int taps = GENERATE(16, 128, 272), count = GENERATE(2, 4);
  std::vector<float> input(static_cast<std::size_t>(taps + kMaxBlock));
  for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<float>(std::sin(0.7 * i * i));
  std::vector<std::vector<float>> filters(4);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < taps; ++k)
      filters[static_cast<std::size_t>(i)].push_back(static_cast<float>(std::cos((1.3 + i) * k * k)));
  const float* const given[] = {filters[0].data(), filters[1].data(), filters[2].data(), filters[3].data()};
  for (const Instructions instructions : available_instructions()) {
    INFO(name(instructions));
    float out[4][kMaxBlock];
    float* const to[] = {out[0], out[1], out[2], out[3]};
    fir(instructions)(input.data() + taps, given, count, taps, to);
    for (int i = 0; i < count; ++i)
      for (int n = 0; n < kMaxBlock; ++n) {
        double sum = 0;
        for (int k = 0; k < taps; ++k)
          sum += static_cast<double>(input[static_cast<std::size_t>(taps + n - k)]) *
                 static_cast<double>(given[i][k]);
        // Each of the products and sums rounds by 2^-24 of at most taps.
        CHECK(std::abs(static_cast<double>(out[i][n]) - sum) < taps * taps * std::pow(2, -24));
      }
  }
}
