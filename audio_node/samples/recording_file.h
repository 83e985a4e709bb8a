// One WAV or FLAC file of a database of recordings: reading, validation and preparation for playback.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "audio_node/samples/layers.h"

namespace tactus::audio {

constexpr double kMaxRecording_s = 20;  // longer recordings are cut (design: no blow rings longer)
constexpr float kMaxSample = 10;        // of a float file: larger values are not sound

// A fault of a file or folder of a database; `what` states the fault and the remedy.
struct SoundFault {
  std::string path, what;
  bool unusable = true;  // it is not played; false: it is played with reduced quality
};

// Accepts sample rates of 8 to 192 kHz and one or two channels; two become one, their mean. Appends its faults;
// empty: it cannot be played. May take a second, so do not call it in a loop. Parses the file in this process: nodes use
// RecordingReader.
std::optional<Recording> read_recording(const std::string& path, Interaction interaction, double rate_Hz,
                                        std::vector<SoundFault>& faults);

// Removes the part before the onset of a blow and fades its end. Empty: it is silent.
std::vector<float> cut_blow(std::vector<float> samples, double rate_Hz);
// Fades the last part of a loop into its first, so that it repeats without a seam; shortens it by that part.
std::vector<float> close_loop(std::vector<float> samples, double rate_Hz);

}  // namespace tactus::audio
