#include "visual_node/overlay/question_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "visual_node/frame/text.h"
#include "visual_node/text/confined_text.h"

namespace tactus::visual {
namespace {

// The capitals of common fonts are 0.72 em high (DejaVu Sans, Noto Sans), those of the letters of rectangles 7 of
// their pixels.
constexpr float kEm = kGlyphHeight / 0.72f;
constexpr const char* kRemedy = "; install a font that does, for example with scripts/setup fonts";

DrawText confined_text() {
  return [reader = std::make_shared<ConfinedText>()](const TextRequest& request) { return reader->draw(request); };
}

TextRequest request_of(const QuestionLayout& layout, bool measure) {
  TextRequest request{{}, measure};
  for (const QuestionBlock& b : layout.blocks()) {
    const auto size = static_cast<int>(std::lround(b.size * kEm)), width = static_cast<int>(b.width);
    request.blocks.push_back(
        {b.text, std::clamp(size, kMinSize_px, kMaxSize_px), std::clamp(width, 1, kMaxTextWidth_px), b.edge});
  }
  return request;
}

// The heights of the blocks on the plate, with the space below them.
std::vector<float> heights_of(const QuestionLayout& layout, const std::vector<DrawnBlock>& blocks, float leading) {
  std::vector<float> heights;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    heights.push_back(static_cast<float>(blocks[i].rows) + leading / 3 * layout.blocks()[i].size);
  return heights;
}

// Cuts rows from the end of the text: the choices or the slider always remain.
void fit(const QuestionLayout& layout, QuestionText& text) {
  const float over = layout.height(heights_of(layout, text.blocks, text.size.leading)) - text.size.height;
  DrawnBlock& question = text.blocks.front();
  if (over > 0) question.rows = std::max(question.line_rows, question.rows - static_cast<int>(std::ceil(over)));
}

}  // namespace

QuestionText typeset_question(const question_t& m, const TextArea& room, const DrawText& draw, float factor) {
  QuestionText text;
  try {
    const std::vector<LetterSize> sizes = letter_sizes(room, factor);
    for (const LetterSize& size : sizes) {
      const QuestionLayout layout(m, plate_width(room), size.size, size.leading);
      DrawnText found = draw(request_of(layout, true));
      text.size = size;
      if (!found.missing.empty()) {
        text.problem = "no installed font covers " + names_of(found.missing) + " of the question" + kRemedy;
        return text;
      }
      const bool last = &size == &sizes.back();
      if (layout.height(heights_of(layout, found.blocks, size.leading)) > size.height && !last) continue;
      found = draw(request_of(layout, false));
      text.blocks = std::move(found.blocks);
      text.picture = std::make_shared<TextPicture>(std::move(found.picture));
      if (last) fit(layout, text);
      return text;
    }
  } catch (const std::runtime_error& e) {
    text.problem = std::string("the question cannot be drawn: ") + e.what();
  }
  return text;
}

void append_question(std::vector<Rect>& overlay, std::vector<Label>& labels, const question_t& m, double number,
                     const TextArea& room, const QuestionText& text, const TextLook& look) {
  const QuestionLayout layout(m, plate_width(room), text.size.size, text.size.leading);
  const std::vector<float> heights = heights_of(layout, text.blocks, text.size.leading);
  if (heights.size() != layout.blocks().size()) return;
  const Eigen::Vector2f at = plate_corner(room, layout.height(heights), text.size.margin);
  layout.draw(overlay, number, at.x(), at.y(), heights, text.blocks.front().right_to_left, look,
              [&](std::size_t block, float x, float y, const Eigen::Vector3f& colour) {
                const DrawnBlock& drawn = text.blocks[block];
                // Whole pixels: the text picture is drawn as it is.
                labels.push_back({text.picture, drawn.first_row, drawn.rows, std::floor(x), std::floor(y),
                                  colour.x(), colour.y(), colour.z()});
              });
}

QuestionTexts::QuestionTexts(bool at_once, std::function<DrawText()> make)
    : at_once_(at_once), make_(make ? std::move(make) : std::function<DrawText()>(confined_text)) {}

void QuestionTexts::take_done() {
  if (!work_ || !work_->task.done()) return;
  QuestionText text;
  try {
    text = std::move(*work_->task.take());
  } catch (const std::exception& e) {
    text.problem = std::string("the question cannot be drawn: ") + e.what();
  }
  if (work_->key == key_ && work_->factor == factor_) done_.push_back({work_->width, work_->height, std::move(text)});
  work_.reset();
}

const QuestionText* QuestionTexts::find(const question_t& m, const TextArea& room, float factor) {
  const sync::QuestionKey key = sync::key_of(m);
  if (key_ != key || factor_ != factor) key_ = key, factor_ = factor, done_.clear();
  const float width = room.right - room.x, height = room.bottom - room.y;
  // The second round finds what was typeset at once.
  for (int round = 0; round < 2; ++round) {
    take_done();
    const auto known = std::find_if(done_.begin(), done_.end(),
                                    [&](const Done& d) { return d.width == width && d.height == height; });
    if (known != done_.end()) return &known->text;
    if (work_ || done_.size() >= kMaxRooms) return nullptr;
    const auto typeset = [m, room, factor, make = make_] {
      return std::make_unique<QuestionText>(typeset_question(m, room, make(), factor));
    };
    if (at_once_)
      done_.push_back({width, height, std::move(*typeset())});
    else
      work_.emplace(Work{key, width, height, factor, sync::BackgroundTask<QuestionText>(typeset)});
  }
  return nullptr;
}

}  // namespace tactus::visual
