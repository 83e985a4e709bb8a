#include "visual_node/overlay/question_input.h"

namespace tactus::visual {
namespace {

// GLFW key codes.
constexpr int kEnter = 257, kRight = 262, kLeft = 263, kDown = 264, kUp = 265, kPad1 = 321, kPad9 = 329,
              kPadEnter = 335;

}  // namespace

std::optional<QuestionInput> question_input(int key) {
  if (key >= '1' && key <= '9') return QuestionInput{.choice = key - '1'};
  if (key >= kPad1 && key <= kPad9) return QuestionInput{.choice = key - kPad1};
  switch (key) {
    case kLeft: return QuestionInput{.fine = -1};
    case kRight: return QuestionInput{.fine = 1};
    case kDown: return QuestionInput{.coarse = -1};
    case kUp: return QuestionInput{.coarse = 1};
    case kEnter:
    case kPadEnter: return QuestionInput{.confirms = true, .continues = true};
    case ' ': return QuestionInput{.continues = true};
    default: return std::nullopt;
  }
}

QuestionInput question_input(Button button) {
  switch (button) {
    case Button::kA: return {.choice = 0, .confirms = true, .continues = true};
    case Button::kB: return {.choice = 1};
    case Button::kX: return {.choice = 2};
    case Button::kY: return {.choice = 3};
    case Button::kLeft: return {.fine = -1};
    case Button::kRight: return {.fine = 1};
    case Button::kUp: return {.coarse = 1};
    case Button::kDown: return {.coarse = -1};
  }
  return {};
}

}  // namespace tactus::visual
