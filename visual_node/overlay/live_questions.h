// The questions of a study on a running node: heard, drawn into each picture, answered by key or gamepad where it
// has a window.
#pragma once

#include <tactus/question_t.hpp>

#include "sync/bus/bus.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/overlay/question_desk.h"

namespace tactus::visual {

class LiveQuestions {
 public:
  explicit LiveQuestions(sync::Bus& bus);

  void configure(const Settings& settings);
  // Once a tick: hears what is asked and repeats what was answered.
  void step();
  // True when the key, or the button, is the study's and nobody else's.
  bool press(int key, sync::HostTime now);
  bool press(Button button, sync::HostTime now);
  // The last to draw over a frame.
  void append(Frame& frame, sync::HostTime now, int picture_width, int picture_height);
  // The frame that was drawn over last was presented then.
  void presented(sync::HostTime at);

 private:
  void send();

  sync::Bus& bus_;
  sync::Queue<question_t>& heard_;
  QuestionDesk desk_;
  bool wanted_ = true, drawn_ = false;
  int markers_px_ = 0;
};

}  // namespace tactus::visual
