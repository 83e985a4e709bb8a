// The current question of the study: repeated until it is answered. Pure.
#pragma once

#include <optional>
#include <span>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::trial_runner {

class Interview {
 public:
  static constexpr sync::Nanoseconds kRepeat{200'000'000};  // lcmtypes/types/control/question_t.lcm

  explicit Interview(std::uint64_t seed) : seed_(seed) { ask({}); }

  // Replaces the current question. Throws std::invalid_argument with one sentence when no answer to it is possible.
  void ask(question_t question);
  // True while a question waits for its answer.
  bool is_open() const { return open_; }
  const question_t& question() const { return question_; }
  // The answer, when it is the first to the current question and fits it.
  std::optional<answer_t> accept(const answer_t& answer);
  // The answer to the current question, from a button of the device or a simulated participant; nullopt: it does not fit the
  // question.
  std::optional<answer_t> answer(int choice, double number, const char* by, sync::HostTime now) const;
  // The pages of the question, when it is due to be published (again); else none. Valid until the next call of ask() or accept().
  std::span<const question_t> step(sync::HostTime now);

 private:
  std::uint64_t seed_, count_ = 0;
  question_t question_{};
  std::vector<question_t> pages_;  // of question_
  bool open_ = false;
  std::optional<sync::HostTime> first_, next_;
};

}  // namespace tactus::trial_runner
