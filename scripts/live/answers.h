// The state of a study for the pages, and the answers of the pages: its leader, the current question, and whether a page has
// answered. Pure: messages are passed in and out.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <utility>

#include "scripts/live/browser_message.h"
#include "sync/bus/recent_map.h"
#include "sync/node/current_question.h"

namespace tactus::live {

class Answers {
 public:
  static constexpr std::size_t kMaxStoredAnswers = 64;  // design: a leader asks one question after the other

  // run_id: as for sync::CurrentQuestion.
  explicit Answers(std::int64_t run_id) : question_(run_id) {}

  void push(const question_t& m, sync::HostTime arrival);
  // The answer of a page. Throws std::invalid_argument with one sentence when it does not fit the current question, or when
  // that has been answered.
  void answer(const PageAnswer& answer, sync::HostTime now);
  // The answer to publish now: once, and again for each repetition of its question.
  std::optional<answer_t> take_answer() { return std::exchange(pending_, std::nullopt); }
  // Call it when the log position has changed.
  void clear() { question_.clear(), pending_.reset(); }

  // The state for the pages; null: no process leads a study. `question` is the name of the question for PageAnswer, as text:
  // JavaScript has no 64-bit integers.
  nlohmann::json to_json(sync::HostTime now) const;
  // header.source of the leader; nullopt: there is none.
  std::optional<std::int32_t> leader(sync::HostTime now) const;

 private:
  sync::CurrentQuestion question_;
  sync::RecentMap<sync::QuestionKey, answer_t> answers_{kMaxStoredAnswers};
  std::optional<answer_t> pending_;
};

}  // namespace tactus::live
