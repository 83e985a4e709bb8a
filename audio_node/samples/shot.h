// Messages to the audio callback about recordings: recording, speed and strength.
#pragma once

#include <array>
#include <cstdint>

#include "audio_node/spatial/source_position.h"
#include "audio_node/samples/layers.h"
#include "sync/time/time.h"

namespace tactus::audio {

// Pointers into a database remain valid while the callback holds anything with its number (recording_player.h).
struct Shot {
  const Recording* recording = nullptr;  // null: none
  float gain = 0;                        // at 1 m
  float step = 1;                        // samples of the recording per sample: its pitch
};

// The recordings of one impact: two layers of the pair, or of each material.
struct RecordedStrike {
  std::int64_t database = 0;  // number of their database; 0: none are played
  std::array<Shot, 4> shots;
  SourcePosition place;
};

// A contact that scrapes or rolls, at one instant, sent every tick.
struct RecordedContact {
  std::int64_t contact = 0;
  std::int32_t part = 0;  // distinguishes the sounds of one contact
  std::int64_t database = 0;
  sync::HostTime at{};  // presentation time
  bool ends = false;    // the contact no longer scrapes or rolls: only contact, part, database and at are valid
  double update_interval_s = 0.001;  // time until the next update
  const Layers* layers = nullptr;
  double speed_m_s = 0;
  float level = 0;  // at 1 m, relative to the recorded loop
  SourcePosition place;
};

}  // namespace tactus::audio
