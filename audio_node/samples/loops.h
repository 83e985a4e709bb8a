// The recordings of contacts that scrape or roll just now, each a loop as long as its contact lasts. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audio_node/samples/shot.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

// Their layers go over into each other by the speed, and each is played as much faster as the contact is than it
// was when it was recorded: what passes a relief twice as fast hears all of it an octave higher (van den Doel, Kry
// and Pai 2001, section 4.2). Realtime-safe: yes.
class Loops {
 public:
  static constexpr int kMax = 32;  // at a time; more are not heard
  // Design: as what is computed (scrapes.cpp), so that both are silent equally soon.
  static constexpr double kEnd_s = 0.002;

  explicit Loops(double rate_Hz, const Space& space = {}, Instructions instructions = Instructions::kSse2)
      : rate_Hz_(rate_Hz), spatialiser_(space, kMax, rate_Hz, instructions) {}

  void hear_from(const Listener& listener) { listener_ = listener; }

  // One that is to be heard from its instant on. True when it begins. One that ends is silent kEnd_s later.
  bool take(const RecordedContact& rub);
  // Adds `frames` <= kMaxBlock frames, channels interleaved, the first of which is heard at `first`.
  void render(float* mix, int frames, sync::HostTime first);

  int active() const;
  // Number of the oldest database that one of them is of; `none` when nothing sounds.
  std::int64_t oldest(std::int64_t none) const;
  void clear() { voices_ = {}; }

 private:
  struct Playing {
    const Recording* recording = nullptr;
    double at = 0;
    float level = 0;  // goes to what is told
  };
  struct Voice {
    RecordedContact now;
    bool on = false;
    int ends_in = -1;  // frames until it is silent; -1: nobody has said that it ends
    int silent = 0;    // frames since the last of which something came
    std::array<Playing, kMaxLayers> layers;
  };
  void render(Voice& voice, int frames, sync::HostTime first);
  // ends_in: as of its voice.
  void add(Playing& playing, double step, float wanted, int ends_in, float* out, int frames) const;

  double rate_Hz_;
  std::array<Voice, kMax> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

}  // namespace tactus::audio
