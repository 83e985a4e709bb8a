#include "audio_node/named_files.h"

#include <filesystem>
#include <stdexcept>

#include "audio_node/mixer/library.h"
#include "audio_node/spatial/space_of.h"

namespace tactus::audio {

void check_named_files(const Settings& settings) {
  const Settings defaults;
  Settings named = settings;
  if (settings.hrtf_file != defaults.hrtf_file) named.spatial = "hrtf", space_of(named, settings.sample_rate_Hz);
  if (settings.layout_file != defaults.layout_file) named.spatial = "loudspeakers", space_of(named, settings.sample_rate_Hz);
  std::error_code ignored;
  if (settings.sounds != defaults.sounds && !std::filesystem::is_directory(sounds_folder(settings.sounds), ignored))
    throw std::runtime_error("the folder of recordings " + settings.sounds + " does not exist; give the path of a folder to the setting sounds");
}

}  // namespace tactus::audio
