#include "visual_node/overlay/live_questions.h"

#include <algorithm>
#include <tactus/question_t.hpp>

#include "visual_node/frame/motion_marker.h"
#include "visual_node/overlay/question_panel.h"

namespace tactus::visual {

LiveQuestions::LiveQuestions(sync::Bus& bus, bool at_once)
    : bus_(bus),
      questions_(bus.queue<question_t>(channels::kQuestion, 64)),
      dialog_(bus.identity().run_id),
      texts_(at_once) {}

void LiveQuestions::configure(const Settings& settings) {
  enabled_ = settings.questions;
  look_ = text_look(settings.text_contrast, settings.text_size);
  markers_px_ = marker_height_px(settings.event_marker == "strip", settings.motion_marker == "strip");
}

void LiveQuestions::step() {
  while (const auto m = questions_.pop())
    if (enabled_) dialog_.push(m->message, m->arrival);
  send();
}

bool LiveQuestions::press(int key, sync::HostTime now) {
  const auto press = question_input(key);
  const bool consumed = enabled_ && press && dialog_.press(*press, "key", now);
  send();
  return consumed;
}

bool LiveQuestions::press(Button button, sync::HostTime now) {
  const bool consumed = enabled_ && dialog_.press(question_input(button), "gamepad", now);
  send();
  return consumed;
}

void LiveQuestions::send() {
  if (auto answer = dialog_.take_answer()) bus_.publish(channels::kAnswer, *answer);
}

// Returns false when the question is not in the picture: it is being typeset, or cannot be drawn.
bool LiveQuestions::append(Frame& frame, const question_t& m, const TextArea& room) {
  if (is_ascii(m)) {
    append_question(frame.list.overlay, m, dialog_.number(), room, look_);
    return true;
  }
  const QuestionText* text = texts_.find(m, room, look_.size);
  if (!text) return false;
  if (text->problem.empty()) {
    append_question(frame.list.overlay, frame.list.labels, m, dialog_.number(), room, *text, look_);
    return true;
  }
  append_lines(frame.list.overlay, {text->problem}, room, text_size(static_cast<int>(room.bottom - room.y), look_), look_);
  if (text->problem != last_problem_) new_problem_ = last_problem_ = text->problem;
  return false;
}

void LiveQuestions::append(Frame& frame, sync::HostTime now, int picture_width, int picture_height) {
  const question_t* m = enabled_ ? dialog_.current(now) : nullptr;
  drawn_ = m != nullptr;
  if (!m) return;
  const auto width = static_cast<float>(picture_width), height = static_cast<float>(picture_height);
  const float free_to = height - static_cast<float>(markers_px_);
  // In stereo each eye sees the question, in its part of the picture.
  std::vector<std::pair<float, float>> parts;
  const auto add = [&](float x, float top, float wide, float high) {
    if (std::find(parts.begin(), parts.end(), std::pair(x, top)) != parts.end()) return;
    parts.emplace_back(x, top);
    drawn_ &= append(frame, *m, {x, top, x + wide, std::min(top + high, free_to)});
  };
  for (const View& v : frame.list.views)
    add(v.x * width, (1 - v.y - v.height) * height, v.width * width, v.height * height);
  if (frame.list.views.empty()) add(0, 0, width, height);
}

void LiveQuestions::presented(sync::HostTime at) {
  if (drawn_) dialog_.set_presented(at);
}

}  // namespace tactus::visual
