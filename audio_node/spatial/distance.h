// What the way to the ear takes off a sound: 1/r of its pressure, and the air its high notes. Pure.
#pragma once

namespace tactus::audio {

// Of one source. Levels are those at 1 m, so that the air counts from there. Realtime-safe: yes.
class Distance {
 public:
  explicit Distance(double rate_Hz);

  // The next sound begins; it is not heard through what the last one left.
  void begin() { fresh_ = true; }
  // Strength and low-pass go straight to where they shall be at the end of these frames.
  void apply(const float* in, float distance_m, int frames, float* out);

 private:
  void hold(const float* in, int frames, float* out);

  double rate_Hz_, air_dB_m_;
  bool fresh_ = true;
  float distance_m_ = 0, gain_ = 0, keep_ = 0;
  float low_ = 0;
};

}  // namespace tactus::audio
