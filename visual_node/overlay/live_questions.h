// The questions of a study on a running node: receives them, draws them into each picture, and publishes answers by
// key or gamepad if it has a window.
#pragma once

#include <tactus/question_t.hpp>

#include "sync/bus/bus.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/overlay/question_dialog.h"

namespace tactus::visual {

class LiveQuestions {
 public:
  explicit LiveQuestions(sync::Bus& bus);

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

 private:
  void send();

  sync::Bus& bus_;
  sync::Queue<question_t>& questions_;
  QuestionDialog dialog_;
  bool enabled_ = true, drawn_ = false;
  int markers_px_ = 0;
};

}  // namespace tactus::visual
