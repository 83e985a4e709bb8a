// The questions of a study at the window: which one is on, since when, where the mark of its number is, and what
// was answered. Pure: messages and presses go in, answers come out.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <utility>

#include "sync/node/current_question.h"
#include "visual_node/overlay/presses.h"

namespace tactus::visual {

class QuestionDesk {
 public:
  static constexpr std::size_t kRemembered = 64;  // design: answers; a leader asks one question after the other
  static constexpr double kCoarseShare = 0.1;     // design: ten presses from end to end
  static constexpr double kMaxSteps = 10'000;    // design: a mark is not moved finer than that

  explicit QuestionDesk(std::int64_t run_id) : asked_(run_id) {}

  void push(const question_t& m, sync::HostTime arrival);
  // Somebody leads a study, whether or not something is asked.
  bool led(sync::HostTime now) const { return asked_.led(now) != nullptr; }
  // What is to be shown; null: nothing, since nothing is asked or it has been answered.
  const question_t* on(sync::HostTime now) const;
  // Where the mark of its number is.
  double number() const;
  // A picture with the question that is on was presented then.
  void seen(sync::HostTime at);

  // True when it is the study's: then it means nothing else. Before the question was seen nothing answers it.
  bool press(const Press& press, const char* by, sync::HostTime now);
  // What is to be sent now: an answer once, and again for each repetition of its question.
  std::optional<answer_t> take_answer() { return std::exchange(to_send_, std::nullopt); }

 private:
  struct Answered {
    sync::QuestionKey key;
    answer_t answer;
  };
  const answer_t* answered(const question_t& m) const;
  void answer(const question_t& m, const char* by, sync::HostTime now, int choice);
  void begin(const question_t& m);

  sync::CurrentQuestion asked_;
  std::optional<sync::QuestionKey> at_;  // what the mark and the time belong to
  double steps_ = 0, mark_ = 0;          // from the lowest to the highest number; of the mark
  std::optional<sync::HostTime> seen_;
  std::deque<Answered> answered_;
  std::optional<answer_t> to_send_;
  double lowest_ = 0, highest_ = 0, step_ = 0;
};

}  // namespace tactus::visual
