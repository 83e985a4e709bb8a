#include "audio_node/spatial/space_of.h"

namespace tactus::audio {

Space space_of(const Settings& settings, double rate_Hz) {
  if (settings.spatial == "hrtf")
    return {std::make_shared<const Hrtf>(load_sofa(settings.hrtf_file), rate_Hz), nullptr};
  if (settings.spatial == "loudspeakers")
    return {nullptr, std::make_shared<const Panning>(load_layout(settings.layout_file))};
  return {};
}

}  // namespace tactus::audio
