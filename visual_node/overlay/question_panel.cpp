#include "visual_node/overlay/question_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "visual_node/frame/text.h"

namespace tactus::visual {
namespace {

const Eigen::Vector3f kWords(1, 1, 1), kKeys(1, 0.78f, 0.25f), kDark(0.05f, 0.06f, 0.08f),
    kQuiet(0.72f, 0.76f, 0.8f);
constexpr float kOpacity = 0.88f;    // design: readable over a bright scene
constexpr float kWidth = 0.9f;       // share of the room
constexpr float kPadding = 4;        // pixels of a letter, as all lengths below
constexpr float kChoiceIndent = 10;  // room for the key before the text
constexpr float kTrack = 22;         // height of a slider with its mark

void fill(std::vector<Rect>& overlay, float x, float y, float width, float height, const Eigen::Vector3f& c,
          float alpha = 1) {
  overlay.push_back({x, y, width, height, c.x(), c.y(), c.z(), alpha});
}

std::size_t letters_across(float width, float size) {
  return static_cast<std::size_t>(std::max(1.0f, std::floor((width / size + 1) / (kGlyphWidth + 1))));
}
float width_of(std::size_t letters, float size) {
  return (static_cast<float>(letters) * (kGlyphWidth + 1) - 1) * size;
}

std::string hint(const question_t& m) {
  if (m.kind == question_t::READ) return "Enter: continue";
  if (m.kind == question_t::NUMBER) return "arrows: move the mark   Enter: answer";
  return "press its number";
}

// The layout of a question in letters of one size; its height is computed before anything is drawn.
class Layout {
 public:
  Layout(const question_t& m, double number, float width, float size, float leading)
      : m_(m), number_(number), size_(size), small_(std::max(1.0f, size - 1)), leading_(leading) {
    inner_ = width - 2 * kPadding * size_;
    text_ = wrap_text(m.text, letters_across(inner_, size_));
    if (m.kind == question_t::CHOICE)
      for (const std::string& c : m.choices)
        choices_.push_back(wrap_text(c, letters_across(inner_ - kChoiceIndent * size_, size_)));
    if (m.kind == question_t::NUMBER) {
      const std::string low = m.count == 2 ? m.choices[0] : number_text(m.lowest, m.step),
                        high = m.count == 2 ? m.choices[1] : number_text(m.highest, m.step);
      for (const std::string& end : {low, high})
        ends_.push_back(wrap_text(end, letters_across(inner_ / 2 - 4 * size_, size_)));
    }
    foot_ = wrap_text(hint(m), letters_across(inner_, small_));
    if (!m.progress.empty()) {
      const auto progress = wrap_text(m.progress, letters_across(inner_, small_));
      foot_.insert(foot_.end(), progress.begin(), progress.end());
    }
  }

  float height() const {
    float lines = static_cast<float>(text_.size());
    for (const auto& c : choices_) lines += static_cast<float>(c.size()) + 0.3f;
    float h = lines * line(size_) + 2 * kPadding * size_ + gap() + static_cast<float>(foot_.size()) * line(small_);
    if (!choices_.empty()) h += gap();
    if (!ends_.empty())
      h += gap() + line(size_) + kTrack * size_ +
           static_cast<float>(std::max(ends_[0].size(), ends_[1].size())) * line(size_);
    return h;
  }
  // Removes lines from the end of the text: the choices or the slider always remain.
  void fit(float height_px) {
    while (text_.size() > 1 && height() > height_px) text_.pop_back();
  }

  void draw(std::vector<Rect>& overlay, float x, float y, float width) const {
    fill(overlay, x, y, width, height(), kDark, kOpacity);
    const float left = x + kPadding * size_;
    y += kPadding * size_;
    y = lines(overlay, text_, left, y, size_, kWords);
    if (!choices_.empty()) y += gap();
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      y += 0.3f * line(size_);
      fill(overlay, left - size_, y - size_, (kGlyphWidth + 2) * size_, (kGlyphHeight + 2) * size_, kKeys);
      append_letters(overlay, std::to_string(i + 1), left, y, size_, kDark);
      y = lines(overlay, choices_[i], left + kChoiceIndent * size_, y, size_, kWords);
    }
    if (!ends_.empty()) y = slider(overlay, left, y + gap());
    lines(overlay, foot_, left, y + gap(), small_, kQuiet);
  }

 private:
  float line(float size) const { return (kGlyphHeight + leading_) * size; }
  float gap() const { return leading_ * size_; }

  float lines(std::vector<Rect>& overlay, const std::vector<std::string>& all, float x, float y, float size,
              const Eigen::Vector3f& colour, bool to_right = false) const {
    for (const std::string& text : all) {
      append_letters(overlay, text, to_right ? x - width_of(text.size(), size) : x, y, size, colour);
      y += line(size);
    }
    return y;
  }

  float slider(std::vector<Rect>& overlay, float left, float y) const {
    const auto share = static_cast<float>((number_ - m_.lowest) / (m_.highest - m_.lowest));
    const float knob = 6 * size_, track = inner_ - knob, at = left + knob / 2 + track * share;
    const std::string value = number_text(number_, m_.step);
    const float wide = width_of(value.size(), size_);
    append_letters(overlay, value, std::clamp(at - wide / 2, left, std::max(left, left + inner_ - wide)), y, size_,
                   kKeys);
    y += line(size_);
    const float middle = y + kTrack * size_ / 2;
    const double steps = (m_.highest - m_.lowest) / m_.step;
    constexpr double kMaxMarks = 20;  // design: more cannot be distinguished
    const int marks = steps <= kMaxMarks ? static_cast<int>(std::lround(steps)) : 10;
    for (int i = 0; i <= marks; ++i)
      fill(overlay, left + knob / 2 + track * static_cast<float>(i) / static_cast<float>(marks) - size_ / 2,
           middle - 4 * size_, size_, 8 * size_, kQuiet);
    fill(overlay, left + knob / 2, middle - size_, track, 2 * size_, kQuiet);
    fill(overlay, at - knob / 2, middle - 8 * size_, knob, 16 * size_, kKeys);
    y += kTrack * size_;
    const float low = lines(overlay, ends_[0], left, y, size_, kWords);
    return std::max(low, lines(overlay, ends_[1], left + inner_, y, size_, kWords, true));
  }

  const question_t& m_;
  double number_;
  float size_, small_, leading_, inner_ = 0;
  std::vector<std::string> text_, foot_;
  std::vector<std::vector<std::string>> choices_, ends_;
};

}  // namespace

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

std::string number_text(double number, double step) {
  int decimals = 0;
  for (double s = step; decimals < 6 && std::abs(s - std::round(s)) > 1e-6 * std::max(1.0, s); s *= 10) ++decimals;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, number == 0 ? 0.0 : number);
  return text;
}

void append_question(std::vector<Rect>& overlay, const question_t& m, double number, const TextArea& room) {
  const float width = (room.right - room.x) * kWidth, all = room.bottom - room.y;
  const float margin = std::floor(all * 0.03f);
  // A picture of 720 lines: 4 pixels for each pixel of a letter, a letter of 28 lines; 480 lines: 3 pixels.
  const float largest = std::max(1.0f, std::round(all / 180));
  struct Try {
    float size, leading, height;
  };
  std::vector<Try> tries;
  for (float size = largest; size >= std::ceil(largest / 2); --size)
    tries.push_back({size, 3, all * 2 / 3 - margin});
  for (float size = largest; size >= 1; --size) tries.push_back({size, 3, all - 2 * margin});
  tries.push_back({1, 1, all});
  for (const Try& t : tries) {
    Layout layout(m, number, width, t.size, t.leading);
    const bool last = &t == &tries.back();
    if (layout.height() > t.height && !last) continue;
    if (last) layout.fit(t.height);
    const float x = room.x + std::floor((room.right - room.x - width) / 2);
    layout.draw(overlay, x, std::max(room.y, std::floor(room.bottom - layout.height() - (last ? 0 : margin))),
                width);
    return;
  }
}

}  // namespace tactus::visual
