// A question in characters beyond ASCII: its texts are typeset once for each size of room, in a thread of its own,
// and drawn as labels.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tactus/question_t.hpp>
#include <vector>

#include "sync/node/background_task.h"
#include "sync/node/current_question.h"
#include "visual_node/overlay/question_layout.h"
#include "visual_node/text/text_blocks.h"

namespace tactus::visual {

// The typeset texts of a question for a room of one size.
struct QuestionText {
  std::shared_ptr<const TextPicture> picture;
  std::vector<DrawnBlock> blocks;  // in the order of QuestionLayout::blocks()
  LetterSize size{};
  std::string problem;  // why it cannot be drawn, in one sentence of ASCII; empty: it can
};

// Draws text: draw_text in a process of its own, or a substitute in tests. Throws std::runtime_error with one
// clause.
using DrawText = std::function<DrawnText(const TextRequest&)>;

// Typesets with the largest letters that fit, as append_question() of question_panel.h. factor: TextLook::size. Not for the loop of a
// node.
QuestionText typeset_question(const question_t& m, const TextArea& room, const DrawText& draw, float factor = 1);

// Draws it with its mark at `number`. text: without a problem, and for a room of this size.
void append_question(std::vector<Rect>& overlay, std::vector<Label>& labels, const question_t& m, double number,
                     const TextArea& room, const QuestionText& text, const TextLook& look = {});

// The typeset texts of the current question. Realtime-safe: find() does not wait, unless it works at once.
class QuestionTexts {
 public:
  static constexpr std::size_t kMaxRooms = 4;  // design: the parts of a stereo picture have one or two sizes

  // at_once: find() typesets and waits, for a log. make: the source of drawn text, called in the thread that
  // draws.
  explicit QuestionTexts(bool at_once, std::function<DrawText()> make = {});

  // Null while it is being typeset, and when there are more than kMaxRooms sizes.
  const QuestionText* find(const question_t& m, const TextArea& room, float factor = 1);

 private:
  struct Done {
    float width, height;
    QuestionText text;
  };
  struct Work {
    sync::QuestionKey key;
    float width, height, factor;
    sync::BackgroundTask<QuestionText> task;
  };
  void take_done();

  bool at_once_;
  std::function<DrawText()> make_;
  std::optional<sync::QuestionKey> key_;  // of the texts in done_
  float factor_ = 1;                      // on the size of their letters
  std::vector<Done> done_;
  std::optional<Work> work_;
};

}  // namespace tactus::visual
