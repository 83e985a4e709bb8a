#include "audio_node/excitation/peak.h"

#include <algorithm>
#include <cmath>

namespace tactus::audio {
namespace {

// Time after the blow over which the peak is searched: modes are loudest while they are in phase, and a mode of 40
// Hz has completed its first swing.
constexpr double kPeakWindow_s = 0.01;  // design

// Adds the sound of one side in the block that begins `begin` samples after the onset.
void add(const StrikeSide& side, const ForcePulse& pulse, int begin, PerMode& velocity, PerMode& displacement,
         std::array<float, kMaxBlock>& out) {
  std::array<float, kMaxBlock> force;
  float before = weight_at(pulse, begin - 1);
  for (int n = 0; n < kMaxBlock; ++n) {
    const float weight = weight_at(pulse, begin + n);
    force[static_cast<std::size_t>(n)] = side.impulse * weight;
    out[static_cast<std::size_t>(n)] += side.click * (weight - before);
    before = weight;
  }
  const Push push{side.gains.data(), force.data()};
  const int modes = (side.resonators->count + kModeGroup - 1) / kModeGroup * kModeGroup;
  ring(Instructions::kSse2)({side.resonators->damping.data(), side.resonators->stiffness.data(), velocity.data(),
                             displacement.data(), modes},
                            &push, 1, kMaxBlock, out.data());
}

}  // namespace

double peak_Pa(const Strike& strike, double rate_Hz) {
  std::array<PerMode, 2> velocity{}, displacement{};
  float peak = 0;
  const int end = length_of(strike.pulse) + static_cast<int>(kPeakWindow_s * rate_Hz);
  for (int begin = 0; begin < end; begin += kMaxBlock) {
    std::array<float, kMaxBlock> out{};
    for (std::size_t i = 0; i < 2; ++i)
      add(strike.sides[i], strike.pulse, begin, velocity[i], displacement[i], out);
    for (const float x : out) peak = std::max(peak, std::abs(x));
  }
  return static_cast<double>(peak);
}

}  // namespace tactus::audio
