// The surfaces that scrape just now. A tip that slides over a profile is pushed up and down by its slope: the
// sound is the slope of the relief under the contact, at the speed with which it passes, and stronger with the
// root of the power that friction takes (van den Doel, Kry and Pai 2001, "FoleyAutomatic", section 4.2). Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audio_node/scrape.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

class Scrapes {
 public:
  static constexpr int kMost = 16;  // at a time; more are not heard

  explicit Scrapes(double rate_Hz, const Space& space = {}, Instructions instructions = Instructions::kSse2)
      : rate_Hz_(rate_Hz), spatialiser_(space, kMost, rate_Hz, instructions) {}

  // One that is to be heard from its instant on. Realtime-safe: yes.
  void take(const Scrape& scrape);
  // They stay where they are in the world. Realtime-safe: yes.
  void hear_from(const Listener& listener) { listener_ = listener; }
  // Adds `frames` <= kMaxBlock frames, channels interleaved, the first of which is heard at `first`.
  // Realtime-safe: yes.
  void render(float* mix, int frames, sync::HostTime first);
  int active() const;
  // Number of the oldest scrape that it holds, and whose relief it may still read. Realtime-safe: yes.
  std::optional<std::int64_t> oldest() const;
  void clear() { voices_ = {}; }

 private:
  struct Voice {
    Scrape now;
    bool on = false;
    double u = 0, v = 0, travelled_m = 0;  // of the sample that comes next
    float level = 0;                       // goes to that of `now`
    sync::HostTime heard{};                // of the newest
    int silent = 0;                        // frames since the last of which something came
  };
  void render(Voice& voice, int frames, sync::HostTime first);

  double rate_Hz_;
  std::array<Voice, kMost> voices_;
  Spatialiser spatialiser_;
  std::optional<Listener> listener_;
};

// Slope of the roughness that every surface has, after so much way: the same in every run, mean square 1.
double roughness(double travelled_m);

}  // namespace tactus::audio
