#include "visual_node/text/confined_text.h"

#include <stdexcept>

namespace tactus::visual {

ConfinedText::ConfinedText()
    : session_("draw_text", {}, {.max_bytes = kMaxTextPixels + (std::size_t{1} << 20), .timeout = kTimeout}) {}

DrawnText ConfinedText::draw(const TextRequest& request) {
  DrawnText text = unpack_drawn_text(session_.request(pack(request)));
  const bool whole = text.blocks.size() == request.blocks.size();
  if (text.missing.empty() && !whole) throw std::runtime_error("its reader returned another text");
  for (const DrawnBlock& b : text.blocks)
    if (!request.measure && text.missing.empty() && b.first_row + b.rows > text.picture.height)
      throw std::runtime_error("its reader returned another text");
  return text;
}

}  // namespace tactus::visual
