// Intended drop-outs: periodic silence of a given length. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace tactus::audio {

struct DropoutDef {
  double length_s = 0;  // 0: none
  double every_s = 0;

  bool operator==(const DropoutDef&) const = default;
};

// Silent for `length` from every multiple of `every` on, counted in samples from the first one, so that switching
// it on and off does not move it. Its edges are raised cosines, which begin at the beginning and at the end of the
// silence: the amplitude is below half for exactly its length. Realtime-safe: yes.
class Dropout {
 public:
  explicit Dropout(double rate_Hz);

  void set(const DropoutDef& def);
  // Factors of the next samples; fills the span.
  void next(std::span<float> gains);

 private:
  // Shorter is audible as a click, longer shortens a short drop-out (design; the minimum length in a profile is 1
  // ms).
  static constexpr double kEdge_s = 0.001;

  double rate_Hz_;
  int edge_;  // samples
  std::int64_t length_ = 0, every_ = 0;
  std::int64_t sample_ = 0;
  int open_;  // position in the edge, samples: 0 silent, edge_ open
};

}  // namespace tactus::audio
