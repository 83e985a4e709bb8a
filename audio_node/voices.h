// The resonators of the bodies that sound just now. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "audio_node/strike.h"

namespace tactus::audio {

inline constexpr int kMaxBlock = 64;  // frames that are rendered at once

// A fixed number of voices, each one body. A mode is a complex one-pole (the coupled form, which keeps low
// frequencies exact in single precision): z <- p z + response * force; its real part sounds. Striking a voice that
// sounds adds a force pulse and leaves z alone. When all voices are in use, the weakest gives way. Realtime-safe:
// yes, all but the constructor.
class Voices {
 public:
  explicit Voices(int voices);

  // Starts a pulse for one side at `offset` frames (0 .. kMaxBlock-1) into the next render().
  void strike(const StrikeSide& side, int pulse_samples, int offset);
  // Adds `frames` <= kMaxBlock frames, left and right interleaved.
  void render(float* mix, int frames);

  int active() const;
  // Sum of |z|^2 over all modes of all voices.
  double energy() const;

 private:
  using Lanes = Eigen::Array<float, kLanes, 1>;
  static constexpr int kGroups = kMaxModes / kLanes;
  static constexpr int kPulses = 8;  // of one voice at a time; more are merged into the newest

  struct Pulse {
    int begin = 0;    // frames until it starts; negative: since it did
    int samples = 0;  // 0: free
    float impulse = 0, click = 0;
    float weight = 0;  // at the sample before
  };
  struct Voice {
    std::int64_t id = -1;
    int groups = 0;
    std::array<Lanes, kGroups> re, im, pole_re, pole_im, response;
    std::array<Pulse, kPulses> pulses{};
    float left = 0, right = 0, left_to = 0, right_to = 0;
    float level = 0;  // largest |z| sum of the last block
  };

  Voice& voice_for(std::int64_t id);
  static bool force(Voice& voice, int frames, float* force, float* out);
  static void resonate(Voice& voice, int frames, const float* force, float* out);

  std::vector<Voice> voices_;
};

}  // namespace tactus::audio
