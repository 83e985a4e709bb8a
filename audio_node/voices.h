// The resonators of the bodies that sound just now. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "audio_node/bank/ring.h"
#include "audio_node/strike.h"

namespace tactus::audio {

// How much may sound at a time.
struct VoiceLimits {
  int voices = 64;
  int modes_of =
      1;  // of the modes of a body one in so many, the lowest, in whole groups of kLanes: its pitch stays
};

// A fixed number of voices, each one body. A mode is a complex one-pole (the coupled form, which keeps low
// frequencies exact in single precision): z <- p z + response * force; its real part sounds. Striking a voice that
// sounds adds a force pulse and leaves z alone. When all voices are in use, the weakest gives way; it fades, as
// does all that lower limits cut. Realtime-safe: yes, all but the constructor.
class Voices {
 public:
  // As many voices as no limit will exceed.
  Voices(int voices, double rate_Hz);

  // From the next render() on.
  void set_limits(const VoiceLimits& limits);

  // Starts a pulse for one side, `gain` as strong as it says, at `offset` frames (0 .. kMaxBlock-1) into the next
  // render().
  void strike(const StrikeSide& side, float gain, int pulse_samples, int offset);
  // Adds `frames` <= kMaxBlock frames, left and right interleaved.
  void render(float* mix, int frames);

  // That sound, with those that fade.
  int active() const;
  // Sum of |z|^2 over all modes of all voices.
  double energy() const;

 private:
  using Lanes = Eigen::Array<float, kLanes, 1>;
  static constexpr int kGroups = kMaxModes / kLanes;
  static constexpr int kPulses = 8;  // of one voice at a time; more are merged into the newest
  // Voices that fade while others sound: so many may be taken within a fade before one ends at once.
  static constexpr int kFading = 16;  // design
  // Of what is cut. Shorter is heard as a click (design).
  static constexpr double kFade_s = 0.005;

  struct Pulse {
    int begin = 0;    // frames until it starts; negative: since it did
    int samples = 0;  // 0: free
    float impulse = 0, click = 0;
    float weight = 0;  // at the sample before
  };
  // A factor that goes to 0 from when it is told to.
  struct Fade {
    bool on = false;
    float gain = 1;
  };
  struct Voice {
    Voice() {
      for (auto* all : {&re, &im, &pole_re, &pole_im, &response}) all->fill(Lanes::Zero());
    }
    std::int64_t id = -1;
    int groups = 0;  // of the body
    // Groups that are rendered; those from `kept` on fade, then they are at rest until the voice is struck anew.
    int rendered = 0, kept = 0;
    Fade cut;
    Fade whole;
    std::array<Lanes, kGroups> re, im, pole_re, pole_im, response;
    std::array<Pulse, kPulses> pulses{};
    float left = 0, right = 0, left_to = 0, right_to = 0;
    float expected = 0;  // level that the last pulse will give
    float level = 0;     // largest |z| sum of the last block; while a pulse is on, what is expected besides
  };

  Voice* sounding(std::int64_t id);
  Voice& free_voice();
  void leave_room(int at_most);
  void take(Voice& voice, const StrikeSide& side) const;
  void cut(Voice& voice) const;
  int allowed(const Voice& voice) const;
  void end_cut(Voice& voice) const;
  void render(Voice& voice, float* mix, int frames) const;
  void fade(Fade& fade, float* samples, int frames) const;
  static bool force(Voice& voice, int frames, float* force, float* out);
  static void resonate(Voice& voice, int from, int to, int frames, const float* force, float* out);

  VoiceLimits limits_;
  float fade_step_;  // a sample
  std::vector<Voice> voices_;
};

}  // namespace tactus::audio
