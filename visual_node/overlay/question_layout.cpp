#include "visual_node/overlay/question_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "visual_node/frame/text.h"

namespace tactus::visual {
namespace {

constexpr float kWidth = 0.9f;       // share of the room
constexpr float kPadding = 4;        // pixels of a letter, as all lengths below
constexpr float kChoiceIndent = 10;  // room for the key before the text
constexpr float kTrack = 22;         // height of a slider with its mark
constexpr float kChoiceGap = 0.3f;   // before a choice, in lines

void fill(std::vector<Rect>& overlay, float x, float y, float width, float height, const Eigen::Vector3f& c) {
  overlay.push_back({x, y, width, height, c.x(), c.y(), c.z(), 1});
}

std::string hint(const question_t& m) {
  if (!m.hint.empty()) return m.hint;
  if (m.kind == question_t::READ) return "Enter: continue";
  if (m.kind == question_t::NUMBER) return "arrows: move the mark   Enter: answer";
  return "press its number";
}

}  // namespace

QuestionLayout::QuestionLayout(const question_t& m, float width, float size, float leading)
    : m_(m),
      width_(width),
      size_(size),
      small_(std::max(1.0f, size - 1)),
      leading_(leading),
      inner_(width - 2 * kPadding * size) {
  blocks_.push_back({m.text, inner_, size_});
  if (m.kind == question_t::CHOICE)
    for (const std::string& c : m.choices)
      blocks_.push_back({c, inner_ - kChoiceIndent * size_, size_}), ++choices_;
  if (m.kind == question_t::NUMBER) {
    const float half = inner_ / 2 - 4 * size_;
    blocks_.push_back({m.count == 2 ? m.choices[0] : number_text(m.lowest, m.step), half, size_, TextEdge::kLeft});
    blocks_.push_back(
        {m.count == 2 ? m.choices[1] : number_text(m.highest, m.step), half, size_, TextEdge::kRight});
    ends_ = 2;
  }
  blocks_.push_back({hint(m), inner_, small_});
  if (!m.progress.empty()) blocks_.push_back({m.progress, inner_, small_});
}

float QuestionLayout::line(float size) const { return (kGlyphHeight + leading_) * size; }

float QuestionLayout::height(const std::vector<float>& blocks) const {
  float h = 2 * kPadding * size_ + gap();
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (i == 0 || i > ends_) h += blocks[i];
  if (choices_ > 0) h += gap() + static_cast<float>(choices_) * kChoiceGap * line(size_);
  if (ends_ > 0) h += gap() + line(size_) + kTrack * size_ + std::max(blocks[1], blocks[2]);
  return h;
}

void QuestionLayout::draw(std::vector<Rect>& overlay, double number, float x, float y,
                          const std::vector<float>& blocks, bool mirrored, const TextLook& look,
                          const DrawBlock& draw_block) const {
  append_plate(overlay, look.question, x, y, width_, height(blocks));
  const float left = x + kPadding * size_;
  y += kPadding * size_;
  draw_block(0, left, y, look.words);
  y += blocks[0];
  if (choices_ > 0) y += gap();
  for (std::size_t i = 1; i <= choices_; ++i) {
    y += kChoiceGap * line(size_);
    const float key = mirrored ? left + inner_ - kGlyphWidth * size_ : left;
    fill(overlay, key - size_, y - size_, (kGlyphWidth + 2) * size_, (kGlyphHeight + 2) * size_, look.keys);
    append_letters(overlay, std::to_string(i), key, y, size_, look.on_keys);
    draw_block(i, mirrored ? left : left + kChoiceIndent * size_, y, look.words);
    y += blocks[i];
  }
  if (ends_ > 0) y = slider(overlay, number, left, y + gap(), blocks, look, draw_block);
  y += gap();
  for (std::size_t i = 1 + choices_ + ends_; i < blocks.size(); y += blocks[i], ++i)
    draw_block(i, left, y, look.quiet);
}

float QuestionLayout::slider(std::vector<Rect>& overlay, double number, float left, float y,
                             const std::vector<float>& blocks, const TextLook& look,
                             const DrawBlock& draw_block) const {
  const auto share = static_cast<float>((number - m_.lowest) / (m_.highest - m_.lowest));
  const float knob = 6 * size_, track = inner_ - knob, at = left + knob / 2 + track * share;
  const std::string value = number_text(number, m_.step);
  const float wide = (static_cast<float>(value.size()) * (kGlyphWidth + 1) - 1) * size_;
  append_letters(overlay, value, std::clamp(at - wide / 2, left, std::max(left, left + inner_ - wide)), y, size_,
                 look.keys);
  y += line(size_);
  const float middle = y + kTrack * size_ / 2;
  const double steps = (m_.highest - m_.lowest) / m_.step;
  constexpr double kMaxMarks = 20;  // design: more cannot be distinguished
  const int marks = steps <= kMaxMarks ? static_cast<int>(std::lround(steps)) : 10;
  for (int i = 0; i <= marks; ++i)
    fill(overlay, left + knob / 2 + track * static_cast<float>(i) / static_cast<float>(marks) - size_ / 2,
         middle - 4 * size_, size_, 8 * size_, look.quiet);
  fill(overlay, left + knob / 2, middle - size_, track, 2 * size_, look.quiet);
  fill(overlay, at - knob / 2, middle - 8 * size_, knob, 16 * size_, look.keys);
  y += kTrack * size_;
  draw_block(1, left, y, look.words);
  draw_block(2, left + inner_ - blocks_[2].width, y, look.words);
  return y + std::max(blocks[1], blocks[2]);
}

std::vector<LetterSize> letter_sizes(const TextArea& room, float factor) {
  const float all = room.bottom - room.y, margin = std::floor(all * 0.03f);
  // A picture of 720 lines: 4 pixels for each pixel of a letter, a letter of 28 lines; 480 lines: 3 pixels.
  const float largest = std::max(1.0f, std::round(factor * std::max(1.0f, std::round(all / 180)))), half = std::ceil(largest / 2);
  std::vector<LetterSize> sizes;
  for (float size = largest; size >= half; --size) {
    sizes.push_back({size, 3, all * 2 / 3 - margin, margin});
    if (factor > 1) sizes.push_back({size, 3, all - 2 * margin, margin});
  }
  for (float size = factor > 1 ? half - 1 : largest; size >= 1; --size) sizes.push_back({size, 3, all - 2 * margin, margin});
  sizes.push_back({1, 1, all, 0});
  return sizes;
}

float plate_width(const TextArea& room) { return (room.right - room.x) * kWidth; }

Eigen::Vector2f plate_corner(const TextArea& room, float height, float margin) {
  return {room.x + std::floor((room.right - room.x - plate_width(room)) / 2),
          std::max(room.y, std::floor(room.bottom - height - margin))};
}

std::string number_text(double number, double step) {
  int decimals = 0;
  for (double s = step; decimals < 6 && std::abs(s - std::round(s)) > 1e-6 * std::max(1.0, s); s *= 10) ++decimals;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, number == 0 ? 0.0 : number);
  return text;
}

}  // namespace tactus::visual
