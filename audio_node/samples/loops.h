// The recordings of contacts that currently scrape or roll, each a loop for the duration of its contact. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audio_node/samples/shot.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

// The layers crossfade with the speed, and each is played at the ratio of the speed of the contact to its recorded
// speed: passing a relief twice as fast raises the sound by an octave (van den Doel, Kry and Pai 2001, section
// 4.2). Realtime-safe: yes.
class Loops {
 public:
  static constexpr int kMax = 32;  // at a time; further ones are silent
  // Design: as for computed scrapes (scrapes.cpp), so that both end after the same time.
  static constexpr double kEnd_s = 0.002;

  explicit Loops(double rate_Hz, const Space& space = {}, Instructions instructions = Instructions::kSse2)
      : rate_Hz_(rate_Hz), spatialiser_(space, kMax, rate_Hz, instructions) {}

  void set_listener(const Listener& listener) { listener_ = listener; }

  // Takes a contact that is due. True when it begins. One that ends is silent after kEnd_s.
  bool update(const RecordedContact& contact);
  // Adds `frames` <= kMaxBlock frames, channels interleaved, the first of which is presented at `first`.
  void render(float* mix, int frames, sync::HostTime first);

  int active() const;
  // Number of the oldest database in use; `none` when nothing sounds.
  std::int64_t oldest(std::int64_t none) const;
  void clear() { voices_ = {}; }

 private:
  struct Playing {
    const Recording* recording = nullptr;
    double at = 0;
    float level = 0;  // follows the received level
  };
  struct Voice {
    RecordedContact now;
    bool on = false;
    int ends_in = -1;  // frames until it is silent; -1: its end has not arrived
    int silent = 0;    // frames since the last input
    std::array<Playing, kMaxLayers> layers;
  };
  void render(Voice& voice, int frames, sync::HostTime first);
  // ends_in: of its voice.
  void add(Playing& playing, double step, float wanted, int ends_in, float* out, int frames) const;

  double rate_Hz_;
  std::array<Voice, kMax> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

}  // namespace tactus::audio
