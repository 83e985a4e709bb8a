// The recordings of impacts that sound just now. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "audio_node/samples/shot.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

// A fixed number of them. When all are in use the quietest gives way and fades. Realtime-safe: yes, all but the
// constructor.
class Shots {
 public:
  static constexpr int kMax = 64;  // impacts at a time, as bodies

  explicit Shots(double rate_Hz, const Space& space = {}, Instructions instructions = Instructions::kSse2);

  void hear_from(const Listener& listener) { listener_ = listener; }

  // From the frame `offset` of the next render() on, `gain` as strong as it says.
  void take(const RecordedStrike& strike, float gain, int offset);
  // Adds `frames` <= kMaxBlock frames, channels interleaved.
  void render(float* mix, int frames);

  int active() const;
  // Number of the oldest database that one of them is of; `none` when nothing sounds.
  std::int64_t oldest(std::int64_t none) const;
  void clear();

 private:
  static constexpr int kFading = 16;        // that give way while others sound (design)
  static constexpr double kFade_s = 0.005;  // shorter is heard as a click (design)

  struct Playing {
    Shot shot;
    double at = 0;  // in the recording
  };
  // Those of one impact, summed before they are heard from its place.
  struct Voice {
    std::array<Playing, 4> shots;
    bool on = false;
    std::int64_t database = 0;
    SourcePosition place;
    int silent = 0;  // frames since the last of which something came
    int begin = 0;   // frames until it starts
    bool fades = false;
    float fade = 1;
    float level = 0;  // largest of the last block, as heard
  };
  Voice& free_voice();
  void leave_room();
  void render(Voice& voice, int frames);
  static bool play(Playing& playing, float* out, int frames);

  float fade_step_;
  std::vector<Voice> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

}  // namespace tactus::audio
