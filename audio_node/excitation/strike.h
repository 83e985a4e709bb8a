// Message to the audio callback about one impact. It points to the modes of its bodies (mixer/strike_queue.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/excitation/force_pulse.h"
#include "audio_node/spatial/source_position.h"
#include "audio_node/samples/shot.h"
#include "sync/time/time.h"

namespace tactus::audio {

inline constexpr int kMaxModes = 128;
static_assert(kMaxModes % kModeGroup == 0);

// One number for each mode of a body; unused modes are 0.
struct alignas(64) PerMode : std::array<float, kMaxModes> {};

// The modes of one body at one sample rate (bank/ring.h).
struct Resonators {
  int count = 0;
  PerMode damping{}, stiffness{};

  // Adds a mode; ignored beyond kMaxModes.
  void add(const ModeStep& step) {
    if (count == kMaxModes) return;
    const auto i = static_cast<std::size_t>(count++);
    damping[i] = step.damping, stiffness[i] = step.stiffness;
  }
};
inline const Resonators kNoModes{};
// The resonators of all bodies of a scene.
using ResonatorTable = std::vector<Resonators>;

// One of the two bodies of an impact.
struct StrikeSide {
  std::int64_t voice = -1;  // the same for the same body: it is excited again without losing its state; -1: none
  const Resonators* resonators = &kNoModes;  // never null; lives while a strike of its scene is held
  PerMode gains{};    // of each mode at the place that is struck, Pa at 1 m per N s; may be negative
  float impulse = 0;  // N s, scaled to full scale per Pa
  float click = 0;    // response to the change between samples of a unit-sum pulse (jerk of the rigid body)
  SourcePosition place;        // position of the source
};

struct Strike {
  std::int64_t event_id = 0;
  std::int64_t scene = 0;  // number of the table that the sides refer to
  sync::HostTime scheduled{};
  ForcePulse pulse = one_hump(1);
  float min_audible_gain = 0;  // factor on its strength below which it is predicted to be inaudible
  std::array<StrikeSide, 2> sides;
  float impulse_N_s = 0, speed_m_s = 0;  // of the blow
  RecordedStrike recorded;
};

}  // namespace tactus::audio
