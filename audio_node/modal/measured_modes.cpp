#include "audio_node/modal/measured_modes.h"

#include <algorithm>
#include <tactus/measured_mode_t.hpp>

namespace tactus::audio {

void apply_measured_modes(BodySound& sound, const material_def_t& material, const Settings& settings) {
  std::vector<measured_mode_t> measured = material.modes;
  std::erase_if(measured, [&](const measured_mode_t& m) {
    return m.frequency_Hz < settings.lowest_frequency_Hz || m.frequency_Hz > settings.highest_frequency_Hz;
  });
  if (measured.empty()) return;
  std::stable_sort(measured.begin(), measured.end(),
                   [](const measured_mode_t& a, const measured_mode_t& b) { return a.amplitude > b.amplitude; });
  if (measured.size() > static_cast<std::size_t>(settings.max_modes))
    measured.resize(static_cast<std::size_t>(settings.max_modes));
  sound.radiation_frequency_Hz = measured.front().frequency_Hz;
  sound.modes.clear();
  for (const measured_mode_t& m : measured)
    sound.modes.push_back({m.frequency_Hz,
                           std::max(kMinDamping_1_s, m.damping_1_s),
                           m.amplitude / measured.front().amplitude,
                           {}});
  std::stable_sort(sound.modes.begin(), sound.modes.end(),
                   [](const Mode& a, const Mode& b) { return a.frequency_Hz < b.frequency_Hz; });
}

}  // namespace tactus::audio
