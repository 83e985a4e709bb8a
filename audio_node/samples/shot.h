// What crosses into the audio callback of recordings: which is played, how fast and how strongly.
#pragma once

#include <array>
#include <cstdint>

#include "audio_node/spatial/source_position.h"
#include "audio_node/samples/layers.h"
#include "sync/time/time.h"

namespace tactus::audio {

// Pointers into a database live while anything that crossed with its number is held (recorded.h).
struct Shot {
  const Recording* recording = nullptr;  // null: none
  float gain = 0;                        // at 1 m
  float step = 1;                        // samples of the recording per sample: its pitch
};

// The recordings that one impact plays: two layers of the pair, or of each material.
struct RecordedStrike {
  std::int64_t database = 0;  // number of the one that they are of; 0: none are played
  std::array<Shot, 4> shots;
  SourcePosition place;
};

// A contact that scrapes or rolls, at one instant. Given anew every tick.
struct RecordedContact {
  std::int64_t contact = 0;
  std::int32_t part = 0;  // of the same contact: another sound
  std::int64_t database = 0;
  sync::HostTime at{};  // when that is to be heard
  bool ends = false;    // the contact scrapes or rolls no more: nothing but contact, part, database and at counts
  double over_s = 0.001;  // until it is told anew
  const Layers* layers = nullptr;
  double speed_m_s = 0;
  float level = 0;  // at 1 m, of a loop as it was recorded
  SourcePosition place;
};

}  // namespace tactus::audio
