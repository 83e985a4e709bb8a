// What crosses into the audio callback of a surface that slides over another: where on it, how fast and how hard.
#pragma once

#include <cstdint>

#include "audio_node/place.h"
#include "lcmtypes/relief.h"
#include "sync/time.h"

namespace tactus::audio {

// At one instant. Given anew every tick; in between the place goes on with its velocity.
struct Scrape {
  std::int64_t id = 0;              // of the contact
  std::int64_t number = 0;          // of all that crossed, from 0
  sync::HostTime at{};              // when that is to be heard
  const Relief* relief = nullptr;   // lives while a scrape of this number is held; null: only the roughness
  double u = 0, v = 0;              // place in repetitions of the relief
  double u_per_s = 0, v_per_s = 0;  // and its velocity
  double along_u = 0, along_v = 0;  // way over the relief per way of the sliding: 0 .. 1 in size
  double travelled_m = 0;           // along the way, m
  double speed_m_s = 0;
  float level = 0;  // full scale per unit of slope
  Place place;      // where it is heard from
};

}  // namespace tactus::audio
