// What pages are told of a study, and the answers that they give: who leads it, what is asked, and whether a page has answered.
// Pure: messages go in and out.
#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <utility>

#include "scripts/live/browser_message.h"
#include "sync/node/current_question.h"

namespace tactus::live {

class Answers {
 public:
  static constexpr std::size_t kRemembered = 64;  // design: a leader asks one question after the other

  // run_id: as of sync::CurrentQuestion.
  explicit Answers(std::int64_t run_id) : asked_(run_id) {}

  void push(const question_t& m, sync::HostTime arrival);
  // The answer of a page. Throws std::invalid_argument with one sentence when it fits no question that is asked, or one that has
  // been answered.
  void answer(const AnswerThus& answer, sync::HostTime now);
  // What is to be sent now: an answer once, and again for each repetition of its question.
  std::optional<answer_t> take_answer() { return std::exchange(to_send_, std::nullopt); }
  // A log was wound.
  void clear() { asked_.clear(), to_send_.reset(); }

  // For pages; null: nobody leads a study. `question` names what is asked for AnswerThus: JavaScript has no integers of 64 bits.
  nlohmann::json told(sync::HostTime now) const;
  // Who leads: header.source; nothing: nobody.
  std::optional<std::int32_t> leader(sync::HostTime now) const;

 private:
  const answer_t* answered(const question_t& m) const;

  sync::CurrentQuestion asked_;
  std::deque<std::pair<sync::QuestionKey, answer_t>> answered_;
  std::optional<answer_t> to_send_;
};

}  // namespace tactus::live
