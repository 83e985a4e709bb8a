// Energy that an A-weighting filter still gives after its input has stopped. Pure.
#pragma once

#include <array>

#include "audio_node/signal/a_weighting.h"

namespace tactus::audio {

// The filter is linear: z <- A z + b x, y = c z + d x. The energy of its output after the input stops is the
// quadratic form z' W z with W = A' W A + c c' (observability Gramian; Kailath, Linear Systems, 1980,
// section 2.6). One sample x more changes the sum of the energy so far and of that tail by 2 x slope + x^2 square.
// Sums of squares, per sample. Realtime-safe: yes, except the constructor.
class WeightedTail {
 public:
  explicit WeightedTail(double rate_Hz);
  double energy(const AWeighting& filter) const;
  double slope(const AWeighting& filter) const;
  double square() const { return square_; }

 private:
  static constexpr std::size_t kSize = AWeighting::kStates;
  std::array<std::array<double, kSize>, kSize> gramian_{};
  std::array<double, kSize> slope_{};
  double square_ = 0;
};

}  // namespace tactus::audio
