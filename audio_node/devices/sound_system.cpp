#include "audio_node/devices/sound_system.h"

#include <alsa/asoundlib.h>
#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace tactus::audio {
namespace {

void ignore_message(const char*, int, const char*, int, const char*, ...) {}
void ignore_jack_message(const char*) {}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

// ALSA reads its configuration once and keeps it; PortAudio opens the current one.
void use_config(const char* path) {
  if (path)
    setenv("ALSA_CONFIG_PATH", path, 1);
  else
    unsetenv("ALSA_CONFIG_PATH");
  snd_config_update_free_global();
}

}  // namespace

bool has_sound_card() {
  int card = -1;
  if (snd_card_next(&card) == 0 && card >= 0) return true;
  if (std::getenv("PULSE_SERVER")) return true;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime && std::filesystem::exists(std::filesystem::path(runtime) / "pulse" / "native");
}

void silence_sound_libraries() {
  setenv("JACK_NO_START_SERVER", "1", 1);
  snd_lib_error_set_handler(ignore_message);
  // PortAudio loads libjack where it is built with it.
  using Handler = void (*)(const char*);
  using SetHandler = void (*)(Handler);
  for (const char* name : {"jack_set_error_function", "jack_set_info_function"})
    if (const auto set = reinterpret_cast<SetHandler>(dlsym(RTLD_DEFAULT, name))) set(ignore_jack_message);
}

VirtualCard::VirtualCard(const std::string& wav_path, int rate_Hz, int channels, int pairs_fd) {
  const auto plugin =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "libasound_module_pcm_vcard.so";
  if (!std::filesystem::exists(plugin))
    throw std::runtime_error("the virtual sound card " + plugin.string() +
                             " is missing; build it with the target audio_node");
  const std::string text = "pcm_type.vcard { lib " + quoted(plugin) + " }\npcm." + kName + " { type vcard file " +
                           quoted(std::filesystem::absolute(wav_path)) + " rate " + std::to_string(rate_Hz) +
                           " channels " + std::to_string(channels) + " pairs_fd " + std::to_string(pairs_fd) +
                           " hint { show on description \"Tactus virtual card\" } }\n"
                           "pcm.default " +
                           kName + "\n";  // PortAudio 19.6 aborts where there is no default
  config_fd_ = memfd_create("asound.conf", MFD_CLOEXEC);
  if (config_fd_ < 0 || ::write(config_fd_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("cannot keep the configuration of the virtual sound card in memory; free some memory");
  use_config(("/proc/self/fd/" + std::to_string(config_fd_)).c_str());
}

VirtualCard::~VirtualCard() {
  use_config(nullptr);
  ::close(config_fd_);
}

}  // namespace tactus::audio
