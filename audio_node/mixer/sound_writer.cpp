#include "audio_node/mixer/sound_writer.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace tactus::audio {

SNDFILE* open_for_writing(const std::string& path, SF_INFO info, const std::string& option) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  std::string reason = descriptor < 0 ? std::strerror(errno) : "";
  if (descriptor >= 0) {
    // Closes the descriptor, also when it fails.
    if (SNDFILE* const file = sf_open_fd(descriptor, SFM_WRITE, &info, SF_TRUE)) return file;
    reason = sf_strerror(nullptr);
  }
  throw std::runtime_error("cannot write " + path + " (" + reason + "); choose another " + option);
}

}  // namespace tactus::audio
