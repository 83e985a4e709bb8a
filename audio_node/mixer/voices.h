// The resonators of the bodies that currently sound. Pure.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/spatial/glide.h"
#include "audio_node/spatial/spatialiser.h"
#include "audio_node/excitation/strike.h"

namespace tactus::audio {

// Limits on the number of voices and modes.
struct VoiceLimits {
  int voices = 64;
  // Only the lowest modes of a body are rendered, one in modes_of, in whole groups of kModeGroup. So its pitch
  // stays.
  int modes_of = 1;
};

// Force on a body during a contact, for the next rendered frames.
struct Drive {
  std::int64_t voice = -1;
  const Resonators* resonators = nullptr;
  const PerMode* gains = nullptr;  // at the place of the contact, as for a strike
  SourcePosition place;
  const float* force = nullptr;   // N s per sample, scaled to full scale per Pa; read until the end of that render()
  const float* direct = nullptr;  // direct sound at 1 m besides the modes, in the same units; null: none
};

// A fixed number of voices, one per body, whose modes are rendered by bank/ring.h. Striking or driving a sounding
// voice adds a force and keeps its state. When all voices are in use, the weakest fades, as do modes and voices
// beyond lower limits. The modes of a body are summed before they are placed at its newest contact. A ringing
// voice moves there at one revolution a second (glide.h), unless the blow masks it. Realtime-safe: yes, except the
// constructor.
class Voices {
 public:
  // voices: the maximum of all limits.
  Voices(int voices, double rate_Hz, Ring ring, const Space& space = {},
         Instructions instructions = Instructions::kSse2);

  // Applies the limits from the next render() on.
  void set_limits(const VoiceLimits& limits);

  // Starts a pulse for one side, scaled by `gain`, at `offset` frames (0 .. kMaxBlock-1) into the next render().
  void strike(const StrikeSide& side, float gain, const ForcePulse& pulse, int offset);
  // Call before each render() during the contact. At most kDrives of one body are rendered at a time.
  void drive(const Drive& drive);
  // Bodies keep their place in the world, including those that ring already.
  void set_listener(const Listener& listener) { listener_ = listener; }
  // Adds `frames` <= kMaxBlock frames, channels interleaved.
  void render(float* mix, int frames);

  // Silences all voices at once.
  void clear();

  // Number of sounding voices, including fading ones.
  int active() const;
  // Sum of the squared amplitudes of all modes of all voices.
  double energy() const;

  static constexpr int kDrives = 32;

 private:
  static constexpr int kPulses = 16;  // pulses of one voice at a time; more join the strongest of them
  // Voices that fade while others sound: at most this number can be taken within a fade before one ends
  // immediately.
  static constexpr int kFading = 16;  // design
  // Fade time of a cut; a shorter one is audible as a click (design).
  static constexpr double kFade_s = 0.005;

  struct Pulse {
    bool on = false;
    int begin = 0;  // frames until it starts; negative: since it started
    int end = 0;    // after its start
    ForcePulse humps{};
    float impulse = 0, click = 0;
    float weight = 0;  // at the previous sample
    PerMode gains;
  };
  // A factor that decreases to 0 once it is switched on.
  struct Fade {
    bool on = false;
    float gain = 1;
  };
  struct Voice {
    std::int64_t id = -1;
    int modes = 0;  // of the body, in whole groups
    // Rendered modes; those from `kept` on fade, and then stay at rest until the voice is struck again.
    int rendered = 0, kept = 0;
    Fade cut;
    Fade ending;
    PerMode damping, stiffness, velocity, displacement;
    std::array<Pulse, kPulses> pulses;
    std::array<Push, kDrives> drives;
    std::array<const float*, kDrives> direct_sounds;
    int driven = 0;
    SourcePosition place;         // position of the newest contact
    SourcePosition current_place;         // moves smoothly to `place`
    int silent = 0;      // frames since the last input
    float expected = 0;  // expected level of the last pulse
    float last = 0;      // last sample
    float level = 0;  // largest sum of amplitudes of the last block, plus the expected level while a pulse is on
  };
  // Forces on a voice within one block.
  struct Pushes {
    std::array<std::array<float, kMaxBlock>, kPulses> forces;
    std::array<Push, kPulses + kDrives> list;
    int count = 0;
    bool of_blows = false;  // some are blows
  };

  Voice* find_sounding(std::int64_t id);
  Voice& free_voice();
  Voice& voice_for(std::int64_t id, const Resonators& resonators, const SourcePosition& place);
  void fade_weakest(int max_voices);
  void start(Voice& voice, std::int64_t id, const Resonators& resonators, const SourcePosition& place);
  void restore_modes(Voice& voice) const;
  void cut(Voice& voice) const;
  int allowed_modes(const Voice& voice) const;
  void end_cut(Voice& voice) const;
  void render(Voice& voice, int frames);
  void fade(Fade& fade, float* samples, int frames) const;
  static void join(Voice& voice, const Pulse& blow);
  static void silence(Voice& voice, float* samples, int frames);
  static void collect(Voice& voice, int frames, Pushes& pushes, float* out);
  void resonate(Voice& voice, int from, int to, int frames, const Pushes& pushes, float* out) const;

  VoiceLimits limits_;
  Ring ring_;
  float fade_step_;  // per sample
  float glide_step_rad_;
  std::vector<Voice> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

}  // namespace tactus::audio
