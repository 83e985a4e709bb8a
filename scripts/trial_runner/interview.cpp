#include "scripts/trial_runner/interview.h"

#include <stdexcept>

#include "lcmtypes/utf8.h"
#include "lcmtypes/valid.h"
#include "sync/node/question_pages.h"
#include "sync/random/keyed_random.h"

namespace tactus::trial_runner {

void Interview::ask(question_t question) {
  question.header.sim_time_ns = -1;
  question.id = static_cast<std::int64_t>(sync::mixed(seed_, ++count_) >> 2) + 1;
  question_t stamped = question;  // the bus fills the rest of the header
  stamped.header.run_id = stamped.header.incarnation = 1;
  const std::string shown(first_characters(question.text, 40));
  if (!valid(stamped))
    throw std::invalid_argument(
        "the question \"" + shown +
        "\" cannot be asked: text has at most 600 characters of UTF-8 on one line, a choice 40, condition, progress and hint 64; "
        "2 to 9 choices; a number needs lowest < highest and a step > 0");
  question_ = std::move(question);
  pages_ = sync::question_pages(question_);
  open_ = question_.kind != question_t::NOTHING;
  first_.reset(), next_.reset();
}

std::optional<answer_t> Interview::accept(const answer_t& answer) {
  if (!open_ || answer.id != question_.id) return std::nullopt;
  if (question_.kind == question_t::CHOICE && (answer.choice < 0 || answer.choice >= question_.count))
    return std::nullopt;
  if (question_.kind == question_t::NUMBER &&
      !(answer.number >= question_.lowest && answer.number <= question_.highest))
    return std::nullopt;
  question_t nothing{};
  nothing.trial = question_.trial, nothing.condition = question_.condition, nothing.progress = question_.progress;
  ask(nothing);
  return answer;
}

std::optional<answer_t> Interview::answer(int choice, double number, const char* by, sync::HostTime now) const {
  if (!open_ || !first_) return std::nullopt;
  answer_t a{};
  a.header.sim_time_ns = -1;
  a.id = question_.id, a.choice = question_.kind == question_t::CHOICE ? choice : -1;
  a.number = question_.kind == question_t::NUMBER ? number : 0;
  a.after_ns = (now - *first_).count(), a.by = by;
  if (question_.kind == question_t::CHOICE && (choice < 0 || choice >= question_.count)) return std::nullopt;
  return a;
}

std::span<const question_t> Interview::step(sync::HostTime now) {
  if (next_ && now < *next_) return {};
  if (!first_) first_ = now;
  next_ = now + kRepeat;
  return pages_;
}

}  // namespace tactus::trial_runner
