#include "visual_node/overlay/question_panel.h"

#include <algorithm>
#include <cmath>

#include "visual_node/frame/text.h"

namespace tactus::visual {
namespace {

std::size_t letters_across(float width, float size) {
  return static_cast<std::size_t>(std::max(1.0f, std::floor((width / size + 1) / (kGlyphWidth + 1))));
}
float width_of(std::size_t letters, float size) {
  return (static_cast<float>(letters) * (kGlyphWidth + 1) - 1) * size;
}

// The lines of each block, and their heights.
struct WrappedBlocks {
  WrappedBlocks(const QuestionLayout& layout, float leading) : layout_(layout), leading_(leading) {
    for (const QuestionBlock& b : layout.blocks()) {
      lines.push_back(wrap_text(b.text, letters_across(b.width, b.size)));
      heights.push_back(static_cast<float>(lines.back().size()) * step(b.size));
    }
  }
  // Removes lines from the end of the text: the choices or the slider always remain.
  void fit(float height_px) {
    while (lines[0].size() > 1 && layout_.height(heights) > height_px) {
      lines[0].pop_back();
      heights[0] = static_cast<float>(lines[0].size()) * step(layout_.blocks()[0].size);
    }
  }
  void draw(std::vector<Rect>& overlay, std::size_t block, float x, float y, const Eigen::Vector3f& colour) const {
    const QuestionBlock& b = layout_.blocks()[block];
    for (const std::string& text : lines[block]) {
      append_letters(overlay, text, b.edge == TextEdge::kRight ? x + b.width - width_of(text.size(), b.size) : x,
                     y, b.size, colour);
      y += step(b.size);
    }
  }
  float step(float size) const { return (kGlyphHeight + leading_) * size; }

  std::vector<std::vector<std::string>> lines;
  std::vector<float> heights;

 private:
  const QuestionLayout& layout_;
  float leading_;
};

}  // namespace

bool is_ascii(const question_t& m) {
  const auto ascii = [](const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  };
  return ascii(m.text) && ascii(m.progress) && ascii(m.hint) && std::all_of(m.choices.begin(), m.choices.end(), ascii);
}

std::vector<std::string> wrap_text(std::string_view text, std::size_t letters) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    if (text.size() <= letters) {
      lines.emplace_back(text);
      break;
    }
    const std::size_t blank = text.rfind(' ', letters);
    const std::size_t cut = blank != std::string_view::npos && blank > 0 ? blank : letters;
    lines.emplace_back(text.substr(0, cut));
    text.remove_prefix(cut);
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  }
  return lines;
}

void append_question(std::vector<Rect>& overlay, const question_t& m, double number, const TextArea& room,
                     const TextLook& look) {
  const std::vector<LetterSize> sizes = letter_sizes(room, look.size);
  for (const LetterSize& t : sizes) {
    const QuestionLayout layout(m, plate_width(room), t.size, t.leading);
    WrappedBlocks texts(layout, t.leading);
    const bool last = &t == &sizes.back();
    if (layout.height(texts.heights) > t.height && !last) continue;
    if (last) texts.fit(t.height);
    const Eigen::Vector2f at = plate_corner(room, layout.height(texts.heights), t.margin);
    layout.draw(overlay, number, at.x(), at.y(), texts.heights, false, look,
                [&](std::size_t block, float x, float y, const Eigen::Vector3f& colour) {
                  texts.draw(overlay, block, x, y, colour);
                });
    return;
  }
}

}  // namespace tactus::visual
