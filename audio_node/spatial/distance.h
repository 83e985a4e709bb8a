// Attenuation over the distance to the ear: 1/r of the pressure, and the high-frequency loss in air. Pure.
#pragma once

namespace tactus::audio {

// Effects of distance on one source. The input level is that at 1 m, so the absorption of the air counts from
// there. Realtime-safe: yes.
class Distance {
 public:
  explicit Distance(double rate_Hz);

  // Begins the next sound: clears the state of the last one.
  void begin() { fresh_ = true; }
  // Gain and low-pass change linearly to their values at the end of these frames.
  void apply(const float* in, float distance_m, int frames, float* out);

 private:
  void hold(const float* in, int frames, float* out);

  double rate_Hz_, air_dB_m_;
  bool fresh_ = true;
  float distance_m_ = 0, gain_ = 0, keep_ = 0;
  float low_ = 0;
};

}  // namespace tactus::audio
