// Draws a question in ASCII: a plate in the lower part of the picture with its text, and its choices or a
// slider, in letters of rectangles. question_text.h draws questions in other characters. Pure.
#pragma once

#include <string>
#include <string_view>
#include <tactus/question_t.hpp>
#include <vector>

#include "visual_node/overlay/question_layout.h"

namespace tactus::visual {

// Whether all of its texts are ASCII.
bool is_ascii(const question_t& m);

// Breaks text into lines at blanks; a word that is longer than a line is broken at the end of the line. letters >
// 0.
std::vector<std::string> wrap_text(std::string_view text, std::size_t letters);

// Draws question m with its mark at `number`. Uses the largest letters that fit into the lower two thirds of
// `room`, or into all of it when they would be too small to read from a chair.
void append_question(std::vector<Rect>& overlay, const question_t& m, double number, const TextArea& room,
                     const TextLook& look = {});

}  // namespace tactus::visual
