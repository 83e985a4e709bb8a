// The recordings of impacts that currently sound. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "audio_node/samples/shot.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

// A fixed number of voices. When all are in use the quietest fades. Realtime-safe: yes, except the constructor.
class Shots {
 public:
  static constexpr int kMax = 64;  // maximum number of impacts at a time, the same as for bodies

  explicit Shots(double rate_Hz, const Space& space = {}, Instructions instructions = Instructions::kSse2);

  void set_listener(const Listener& listener) { listener_ = listener; }

  // Starts a recording at the frame `offset` of the next render(), scaled by `gain`.
  void start(const RecordedStrike& strike, float gain, int offset);
  // Adds `frames` <= kMaxBlock frames, channels interleaved.
  void render(float* mix, int frames);

  int active() const;
  // Number of the oldest database in use; `none` when nothing sounds.
  std::int64_t oldest(std::int64_t none) const;
  void clear();

 private:
  static constexpr int kFading = 16;        // additional voices that fade out while the others sound (design)
  static constexpr double kFade_s = 0.005;  // shorter is audible as a click (design)

  struct Playing {
    Shot shot;
    double at = 0;  // position in the recording
  };
  // Recordings of one impact, summed before they are placed.
  struct Voice {
    std::array<Playing, 4> shots;
    bool on = false;
    std::int64_t database = 0;
    SourcePosition place;
    int silent = 0;  // frames since the last input
    int begin = 0;   // frames until it starts
    bool fades = false;
    float fade = 1;
    float level = 0;  // peak of the last block at the listener
  };
  Voice& free_voice();
  void fade_weakest();
  void render(Voice& voice, int frames);
  static bool play(Playing& playing, float* out, int frames);

  float fade_step_;
  std::vector<Voice> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

}  // namespace tactus::audio
