// The meaning of keys and gamepad buttons for a question. Pure.
#pragma once

#include <optional>

#include "visual_node/devices/gamepad.h"

namespace tactus::visual {

// One press may have several meanings; the current question selects one of them.
struct QuestionInput {
  int choice = -1;           // from 0; -1: none
  int fine = 0, coarse = 0;  // move the mark of a number: -1 down, 1 up
  bool confirms = false;     // confirms the number at its mark
  bool continues = false;    // confirms that the text has been read
  bool operator==(const QuestionInput&) const = default;
};

// key: codes as in overlay/keys.h. Nothing: no meaning for any question.
std::optional<QuestionInput> question_input(int key);
QuestionInput question_input(Button button);

}  // namespace tactus::visual
