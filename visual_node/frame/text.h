// Text over the picture, made of filled rectangles. It shows the state of a frame in the frame.
#pragma once

#include <string_view>
#include <vector>

#include "visual_node/frame/text_look.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;

// Rows of a letter, digit or sign, top first, the leftmost pixel in bit 4; null: there is no such glyph.
const unsigned char* glyph(char letter);

// Text on a plate whose upper left corner is at (x, y), each pixel of a letter `size` pixels wide, in the colour of the status word.
void append_text(std::vector<Rect>& overlay, std::string_view text, float x, float y, float size, const TextLook& look = {});
// Size of that plate, pixels.
float text_width(std::size_t letters, float size);
constexpr float text_height(float size) { return (kGlyphHeight + 4) * size; }
void append_plate(std::vector<Rect>& overlay, const TextLook::Plate& plate, float x, float y, float width, float height);
// Without a plate; colour in sRGB. A character without a glyph is drawn as a question mark.
void append_letters(std::vector<Rect>& overlay, std::string_view text, float x, float y, float size,
                    const Eigen::Vector3f& colour = Eigen::Vector3f::Ones());

}  // namespace tactus::visual
