#include "audio_node/mixer/sound_writer.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

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

std::string write_error(SNDFILE* file) {
  constexpr std::string_view kSystem = "System error : ";
  std::string reason = sf_strerror(file);
  if (reason.starts_with(kSystem)) reason.erase(0, kSystem.size());
  if (reason.ends_with(".")) reason.pop_back();
  return reason;
}

}  // namespace tactus::audio
