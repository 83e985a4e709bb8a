// Sound files of this node: their format, and opening one by its descriptor, because sf_open accepts paths of at most 1023 bytes.
#pragma once

#include <sndfile.h>

#include <string>

namespace tactus::audio {

// WAV of 32-bit float samples. A format chunk that is not PCM needs the extension field cbSize, and a fact chunk (Microsoft 1994, Multiple
// Media and Data Types, revision 3.0, "WAVEFORMATEX"). libsndfile writes cbSize only with the extensible format.
constexpr int kFloatWav = SF_FORMAT_WAVEX | SF_FORMAT_FLOAT;

// Creates or empties the file. Throws std::runtime_error "cannot write PATH (REASON); choose another OPTION".
SNDFILE* open_for_writing(const std::string& path, SF_INFO info, const std::string& option);

// Why the last writing to the file failed, for example "File too large".
std::string write_error(SNDFILE* file);

}  // namespace tactus::audio
