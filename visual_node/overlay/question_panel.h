// A question as it is drawn: a dark plate in the lower part of the picture with its words, and its choices or the
// slider of its number. Pure.
#pragma once

#include <string>
#include <string_view>
#include <tactus/question_t.hpp>
#include <vector>

#include "visual_node/overlay/panel.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// Cut at blanks; a word that is longer than a line is cut where the line ends. letters > 0.
std::vector<std::string> words_in_lines(std::string_view text, std::size_t letters);

// With as many decimals as the step of the question has, at most six.
std::string number_text(double number, double step);

// Adds question m with its mark at `number`, in as large letters as find room in the lower two thirds of `room`;
// in all of it when they would become too small to read from a chair.
void append_question(std::vector<Rect>& overlay, const question_t& m, double number, const TextRoom& room);

}  // namespace tactus::visual
