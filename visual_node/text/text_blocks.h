// Blocks of text to draw, and the drawn text, as visual_node and the program draw_text exchange them. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

enum class TextEdge : std::uint8_t {
  kNatural,  // the left edge for writing from left to right, the right edge for writing from right to left
  kLeft,
  kRight
};

// A paragraph, broken into lines of at most that width.
struct TextBlock {
  std::string text;  // UTF-8, 0 .. kMaxTextBytes
  int size_px = 0;   // of the letters (em), kMinSize_px .. kMaxSize_px
  int width_px = 0;  // of the lines, 1 .. kMaxTextWidth_px
  TextEdge edge = TextEdge::kNatural;
};

inline constexpr std::size_t kMaxBlocks = 16;  // design: a question, nine choices, hint and progress are twelve
inline constexpr std::size_t kMaxTextBytes = 2400;  // 600 characters of four bytes
inline constexpr int kMinSize_px = 6, kMaxSize_px = 400;
inline constexpr int kMaxTextWidth_px = 8192, kMaxTextRows = 8192;  // textures of this size exist on every device
inline constexpr std::size_t kMaxTextPixels = std::size_t{1} << 24;

// The rows of a block in the text picture.
struct DrawnBlock {
  std::int32_t first_row = 0, rows = 0;  // first_row: 0 when the block was measured only
  std::int32_t line_rows = 0;            // height of its first line
  bool right_to_left = false;            // the direction of its paragraph
};

struct DrawnText {
  TextPicture picture;             // empty when nothing was drawn; as wide as the widest block
  std::vector<DrawnBlock> blocks;  // in the order of the request
  std::vector<char32_t> missing;   // characters that no installed font covers, each once; then nothing is drawn
};

// measure: only the rows of the blocks are computed.
struct TextRequest {
  std::vector<TextBlock> blocks;
  bool measure = false;
};

std::vector<std::uint8_t> pack(const TextRequest& request);
std::vector<std::uint8_t> pack(const DrawnText& text);
// Throw std::runtime_error with one clause when a value is outside of its limits.
TextRequest unpack_text_request(std::span<const std::uint8_t> bytes);
DrawnText unpack_drawn_text(std::span<const std::uint8_t> bytes);

// "U+0905, U+0906 and 3 other characters"; at most `most` of them are named.
std::string names_of(const std::vector<char32_t>& characters, std::size_t most = 4);

}  // namespace tactus::visual
