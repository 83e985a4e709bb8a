#include "scripts/live/answers.h"

#include <stdexcept>

#include "sync/text/printable.h"

namespace tactus::live {
namespace {

using nlohmann::json;

std::string question_name(const question_t& m) { return std::to_string(m.header.incarnation) + "." + std::to_string(m.id); }

std::string kind_name(const question_t& m) {
  switch (m.kind) {
    case question_t::READ: return "read";
    case question_t::CHOICE: return "choice";
    case question_t::NUMBER: return "number";
    default: return "nothing";
  }
}

}  // namespace

void Answers::push(const question_t& m, sync::HostTime arrival) {
  if (!question_.push(m, arrival)) return;
  pending_.reset();
  if (const answer_t* known = answers_.find(sync::key_of(m))) pending_ = *known;
}

void Answers::answer(const PageAnswer& given, sync::HostTime now) {
  const question_t* m = question_.newest(now);
  if (!m || m->kind == question_t::NOTHING || given.question != question_name(*m))
    throw std::invalid_argument("that question is no longer open; answer the shown one");
  if (answers_.find(sync::key_of(*m))) throw std::invalid_argument("that question has been answered; wait for the next");
  if (m->kind == question_t::CHOICE ? given.choice < 0 || given.choice >= m->count : given.choice != -1)
    throw std::invalid_argument("the answer is not one of the choices; reload the page");
  if (m->kind == question_t::NUMBER ? !(given.number >= m->lowest && given.number <= m->highest) : given.number != 0)
    throw std::invalid_argument("the answer is outside the range of its slider; reload the page");
  answer_t a{};
  a.header.sim_time_ns = -1;
  a.header.run_id = a.header.incarnation = 1;  // the bus stamps them
  a.id = m->id, a.choice = given.choice, a.number = given.number, a.after_ns = given.after_ns, a.by = "page";
  answers_.try_emplace(sync::key_of(*m), a);
  pending_ = a;
}

json Answers::to_json(sync::HostTime now) const {
  const question_t* m = question_.newest(now);
  if (!m) return nullptr;
  json choices = json::array();
  for (const std::string& c : m->choices) choices.push_back(sync::printable(c));
  return {{"question", question_name(*m)}, {"kind", kind_name(*m)}, {"text", sync::printable(m->text)}, {"choices", choices},
          {"lowest", m->lowest}, {"highest", m->highest}, {"step", m->step}, {"trial", m->trial},
          {"condition", sync::printable(m->condition)}, {"progress", sync::printable(m->progress)}, {"hint", sync::printable(m->hint)},
          {"answered", answers_.find(sync::key_of(*m)) != nullptr}};
}

std::optional<std::int32_t> Answers::leader(sync::HostTime now) const {
  const question_t* m = question_.newest(now);
  return m ? std::optional(m->header.source) : std::nullopt;
}

}  // namespace tactus::live
