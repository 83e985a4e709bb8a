// The resonators of the bodies that sound just now. Pure.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/spatial/glide.h"
#include "audio_node/spatial/spatialiser.h"
#include "audio_node/excitation/strike.h"

namespace tactus::audio {

// How much may sound at a time.
struct VoiceLimits {
  int voices = 64;
  // Of the modes of a body one in so many, the lowest, in whole groups of kModeGroup: its pitch stays.
  int modes_of = 1;
};

// A force on a body for as long as a contact lasts: that of the frames that are rendered next.
struct Drive {
  std::int64_t voice = -1;
  const Resonators* resonators = nullptr;
  const PerMode* gains = nullptr;  // at the place of the contact, as of a strike
  SourcePosition place;
  const float* force = nullptr;   // N s a sample, scaled to full scale per Pa; read until the end of that render()
  const float* direct = nullptr;  // heard beside the modes, at 1 m, likewise; null: nothing
};

// A fixed number of voices, each one body, whose modes ring in bank/ring.h. Striking or driving a voice that
// sounds adds a force and leaves its state alone. When all voices are in use, the weakest gives way; it fades, as
// does all that lower limits cut. The modes of a body are summed before it is heard from its place. That is where
// its newest contact is; what rings goes there by a turn a second (glide.h), unless the blow drowns it.
// Realtime-safe: yes, all but the constructor.
class Voices {
 public:
  // As many voices as no limit will exceed.
  Voices(int voices, double rate_Hz, Ring ring, const Space& space = {},
         Instructions instructions = Instructions::kSse2);

  // From the next render() on.
  void set_limits(const VoiceLimits& limits);

  // Starts a pulse for one side, `gain` as strong as it says, at `offset` frames (0 .. kMaxBlock-1) into the next
  // render().
  void strike(const StrikeSide& side, float gain, const ForcePulse& pulse, int offset);
  // Before each render() as long as the contact lasts. Of one body so many at a time are heard: kDrives.
  void drive(const Drive& drive);
  // Bodies stay where they are in the world, also those that ring already.
  void hear_from(const Listener& listener) { listener_ = listener; }
  // Adds `frames` <= kMaxBlock frames, channels interleaved.
  void render(float* mix, int frames);

  // That sound, with those that fade.
  int active() const;
  // Sum of the squared amplitudes of all modes of all voices.
  double energy() const;

  static constexpr int kDrives = 32;

 private:
  static constexpr int kPulses = 16;  // of one voice at a time; more join the strongest of them
  // Voices that fade while others sound: so many may be taken within a fade before one ends at once.
  static constexpr int kFading = 16;  // design
  // Of what is cut. Shorter is heard as a click (design).
  static constexpr double kFade_s = 0.005;

  struct Pulse {
    bool on = false;
    int begin = 0;  // frames until it starts; negative: since it did
    int end = 0;    // after its start
    ForcePulse humps{};
    float impulse = 0, click = 0;
    float weight = 0;  // at the sample before
    PerMode gains;
  };
  // A factor that goes to 0 from when it is told to.
  struct Fade {
    bool on = false;
    float gain = 1;
  };
  struct Voice {
    std::int64_t id = -1;
    int modes = 0;  // of the body, in whole groups
    // Modes that are rendered; those from `kept` on fade, then they are at rest until the voice is struck anew.
    int rendered = 0, kept = 0;
    Fade cut;
    Fade whole;
    PerMode damping, stiffness, velocity, displacement;
    std::array<Pulse, kPulses> pulses;
    std::array<Push, kDrives> drives;
    std::array<const float*, kDrives> directs;
    int driven = 0;
    SourcePosition place;         // of the newest contact
    SourcePosition heard;         // on its way there
    int silent = 0;      // frames since the last of which something came
    float expected = 0;  // level that the last pulse will give
    float level = 0;  // largest sum of amplitudes of the last block; while a pulse is on, what is expected besides
  };
  // What pushes a voice within one block.
  struct Pushes {
    std::array<std::array<float, kMaxBlock>, kPulses> forces;
    std::array<Push, kPulses + kDrives> list;
    int count = 0;
    bool of_blows = false;  // some are
  };

  Voice* sounding(std::int64_t id);
  Voice& free_voice();
  Voice& voice_of(std::int64_t id, const Resonators& resonators, const SourcePosition& place);
  void leave_room(int at_most);
  void take(Voice& voice, std::int64_t id, const Resonators& resonators, const SourcePosition& place);
  void bring_back(Voice& voice) const;
  void cut(Voice& voice) const;
  int allowed(const Voice& voice) const;
  void end_cut(Voice& voice) const;
  void render(Voice& voice, int frames);
  void fade(Fade& fade, float* samples, int frames) const;
  static void join(Voice& voice, const Pulse& blow);
  static void collect(Voice& voice, int frames, Pushes& pushes, float* out);
  void resonate(Voice& voice, int from, int to, int frames, const Pushes& pushes, float* out) const;

  VoiceLimits limits_;
  Ring ring_;
  float fade_step_;  // a sample
  float glide_step_rad_;
  std::vector<Voice> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

}  // namespace tactus::audio
