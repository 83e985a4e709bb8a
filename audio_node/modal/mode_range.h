// Selection of the modes of a body by frequency. Pure.
#pragma once

#include <algorithm>
#include <vector>

#include "audio_node/modal/modal.h"

namespace tactus::audio {

// The modes within the range, in order of increasing frequency.
inline std::vector<NaturalFrequency> in_range(std::vector<NaturalFrequency> all, ModeRange range) {
  std::erase_if(all, [&](const NaturalFrequency& m) { return !(m.frequency_Hz > 0 && m.frequency_Hz < range.below_Hz); });
  std::stable_sort(all.begin(), all.end(),
                   [](const NaturalFrequency& a, const NaturalFrequency& b) { return a.frequency_Hz < b.frequency_Hz; });
  if (all.size() > static_cast<std::size_t>(range.max_modes)) all.resize(static_cast<std::size_t>(range.max_modes));
  return all;
}

}  // namespace tactus::audio
