// The dialog of a study's questions at the window: the current question, its presentation time, the mark on its
// number scale, and the answers. Pure: messages and presses go in, answers come out.
#pragma once

#include <deque>
#include <optional>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <utility>

#include "sync/node/current_question.h"
#include "visual_node/overlay/question_input.h"

namespace tactus::visual {

class QuestionDialog {
 public:
  static constexpr std::size_t kMaxAnswers = 64;  // design: stored answers; a study asks one question after the other
  static constexpr double kCoarseShare = 0.1;     // design: ten presses from end to end
  static constexpr double kMaxSteps = 10'000;    // design: the finest resolution of a mark

  explicit QuestionDialog(std::int64_t run_id) : current_(run_id) {}

  void push(const question_t& m, sync::HostTime arrival);
  // True while a study is running, with or without a question.
  bool study_running(sync::HostTime now) const { return current_.newest(now) != nullptr; }
  // The question to show; null: none, or it has been answered.
  const question_t* current(sync::HostTime now) const;
  // The number at the mark.
  double number() const;
  // A picture with the current question was presented at `at`.
  void set_presented(sync::HostTime at);

  // Returns true when the study consumes the press. A press before the question was presented does not answer it.
  bool press(const QuestionInput& press, const char* by, sync::HostTime now);
  // The answer to send now: once, and again for each repetition of its question.
  std::optional<answer_t> take_answer() { return std::exchange(to_send_, std::nullopt); }

 private:
  struct Answered {
    sync::QuestionKey key;
    answer_t answer;
  };
  const answer_t* answered(const question_t& m) const;
  void answer(const question_t& m, const char* by, sync::HostTime now, int choice);
  void begin(const question_t& m);

  sync::CurrentQuestion current_;
  std::optional<sync::QuestionKey> key_;  // the question to which the mark and the time belong
  double steps_ = 0, mark_ = 0;          // number of steps from the lowest to the highest number; step of the mark
  std::optional<sync::HostTime> presented_;
  std::deque<Answered> answered_;
  std::optional<answer_t> to_send_;
  double lowest_ = 0, highest_ = 0, step_ = 0;
};

}  // namespace tactus::visual
