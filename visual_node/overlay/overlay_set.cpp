#include "visual_node/overlay/overlay_set.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "lcmtypes/spelling_suggestions.h"

namespace tactus::visual {

OverlaySet parse_overlays(std::string_view text) {
  OverlaySet set;
  while (true) {
    const std::size_t begin = text.find_first_not_of(" ,\t\n");
    if (begin == std::string_view::npos) return set;
    text.remove_prefix(begin);
    const std::string_view word = text.substr(0, text.find_first_of(" ,\t\n"));
    text.remove_prefix(word.size());
    const auto it = std::find(kOverlayNames.begin(), kOverlayNames.end(), word);
    if (it != kOverlayNames.end()) {
      set.set(static_cast<Overlay>(it - kOverlayNames.begin()));
    } else if (word == "all") {
      for (std::size_t i = 0; i < kOverlayNames.size(); ++i)
        set.set(static_cast<Overlay>(i), kOverlayNames[i] != "help");
    } else if (word != "none") {
      throw std::invalid_argument("there is no overlay \"" + std::string(word.substr(0, 40)) + "\"; nearest: " +
                                  spelling_suggestions(word, {kOverlayNames.begin(), kOverlayNames.end()}));
    }
  }
}

}  // namespace tactus::visual
