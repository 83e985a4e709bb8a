// Draws a question: a dark plate in the lower part of the picture with its text, and its choices or a slider. Pure.
#pragma once

#include <string>
#include <string_view>
#include <tactus/question_t.hpp>
#include <vector>

#include "visual_node/overlay/panel.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// Breaks text into lines at blanks; a word that is longer than a line is broken at the end of the line. letters >
// 0.
std::vector<std::string> wrap_text(std::string_view text, std::size_t letters);

// A number with as many decimals as the step of the question has, at most six.
std::string number_text(double number, double step);

// Draws question m with its mark at `number`. Uses the largest letters that fit into the lower two thirds of
// `room`, or into all of it when they would be too small to read from a chair.
void append_question(std::vector<Rect>& overlay, const question_t& m, double number, const TextArea& room);

}  // namespace tactus::visual
