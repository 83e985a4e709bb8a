// One WAV or FLAC file of a database of recordings: read, judged and made ready to be played.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "audio_node/samples/layers.h"

namespace tactus::audio {

// What is wrong with a file or folder of a database: `what` says it and what to do.
struct SoundFault {
  std::string path, what;
  bool unusable = true;  // it is not played; else it is, and sounds worse than it should
};

// Any sample rate of 8 to 192 kHz, one or two channels, which are summed to one. Appends what is wrong with it;
// nothing: it cannot be played. Reads and computes for as long as a second: not for a loop.
std::optional<Recording> read_recording(const std::string& path, Interaction interaction, double rate_Hz,
                                        std::vector<SoundFault>& faults);

// What is quieter before the first sound of a blow is cut off, and its end fades. Empty: it is silent.
std::vector<float> cut_blow(std::vector<float> samples, double rate_Hz);
// The last part of a loop is faded into its first, so that it goes on without a seam; it is shorter by that.
std::vector<float> close_loop(std::vector<float> samples, double rate_Hz);

}  // namespace tactus::audio
