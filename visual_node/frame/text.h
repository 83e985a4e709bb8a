// Words over the picture, of filled rectangles: how good the frame is must be seen in the frame.
#pragma once

#include <string_view>
#include <vector>

#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;

// Rows of a capital letter, top first, the leftmost pixel in bit 4; null: there is no such glyph.
const unsigned char* glyph(char letter);

// Capital letters on a dark plate whose upper left corner is at (x, y), each pixel of a letter `size` pixels wide.
void append_text(std::vector<Rect>& overlay, std::string_view text, float x, float y, float size);

}  // namespace tactus::visual
