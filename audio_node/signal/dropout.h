// Drop-outs on purpose: silence of a given length, so often. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace tactus::audio {

struct DropoutDef {
  double length_s = 0;  // 0: none
  double every_s = 0;

  bool operator==(const DropoutDef&) const = default;
};

// Silent from every multiple of `every` on for `length`, counted in samples from the first one, so that switching
// it on and off does not move it. Its edges are raised cosines, which begin where the silence begins and where it
// ends: half of the amplitude is gone for exactly its length. Realtime-safe: yes.
class Dropout {
 public:
  explicit Dropout(double rate_Hz);

  void set(const DropoutDef& def);
  // Factors of the next samples, as many as fit.
  void next(std::span<float> gains);

 private:
  // Shorter is heard as a click, longer eats into a short drop-out (design; the least one that a profile can ask
  // for is 1 ms).
  static constexpr double kEdge_s = 0.001;

  double rate_Hz_;
  int edge_;  // samples
  std::int64_t length_ = 0, every_ = 0;
  std::int64_t sample_ = 0;
  int open_;  // samples of the edge that are passed: 0 silent, edge_ open
};

}  // namespace tactus::audio
