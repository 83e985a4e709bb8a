// The questions of a study on a running node: receives them, draws them into each picture, and publishes answers
// by key or gamepad if it has a window.
#pragma once

#include <optional>
#include <string>
#include <tactus/question_t.hpp>
#include <utility>

#include "sync/bus/bus.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/overlay/question_dialog.h"
#include "visual_node/overlay/question_text.h"

namespace tactus::visual {

class LiveQuestions {
 public:
  // at_once: a question in characters beyond ASCII is typeset at once, for a log; otherwise it appears when it is
  // typeset.
  LiveQuestions(sync::Bus& bus, bool at_once);

  void configure(const Settings& settings);
  // Call once a tick: receives questions and repeats answers.
  void step();
  // True when the key or button is reserved for the study.
  bool press(int key, sync::HostTime now);
  bool press(Button button, sync::HostTime now);
  // Call last when a frame is composed.
  void append(Frame& frame, sync::HostTime now, int picture_width, int picture_height);
  // The frame of the last append() was presented then.
  void presented(sync::HostTime at);
  // Why a question cannot be drawn, in one sentence, once for each reason; nothing: it can.
  std::optional<std::string> take_problem() { return std::exchange(new_problem_, std::nullopt); }

 private:
  void send();
  bool append(Frame& frame, const question_t& m, const TextArea& room);

  sync::Bus& bus_;
  sync::Queue<question_t>& questions_;
  QuestionDialog dialog_;
  QuestionTexts texts_;
  std::string last_problem_;
  std::optional<std::string> new_problem_;
  bool enabled_ = true, drawn_ = false;
  int markers_px_ = 0;
  TextLook look_;
};

}  // namespace tactus::visual
