// Opens a sound file for writing by its descriptor: sf_open accepts paths of at most 1023 bytes.
#pragma once

#include <sndfile.h>

#include <string>

namespace tactus::audio {

// Creates or empties the file. Throws std::runtime_error "cannot write PATH (REASON); choose another OPTION".
SNDFILE* open_for_writing(const std::string& path, SF_INFO info, const std::string& option);

}  // namespace tactus::audio
