// Validation of the questions and answers of a study.
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/plausible.h"
#include "lcmtypes/valid.h"

namespace tactus {

bool valid(const question_t& m) {
  const auto choice = [](const std::string& c) { return !c.empty() && c.size() <= 40 && printable(c); };
  const auto line = [](const std::string& l) { return l.size() <= 64 && printable(l); };
  if (!sane(m.header) || m.id <= 0 || m.text.size() > 600 || !printable(m.text) || !between(m.count, 0, 9) ||
      !std::all_of(m.choices.begin(), m.choices.end(), choice) || m.trial < 0 || !line(m.condition) ||
      !line(m.progress))
    return false;
  const bool no_number = m.lowest == 0 && m.highest == 0 && m.step == 0;
  switch (m.kind) {
    case question_t::NOTHING: return no_number && m.text.empty() && m.count == 0;
    case question_t::READ: return no_number && !m.text.empty() && m.count == 0;
    case question_t::CHOICE: return no_number && !m.text.empty() && m.count >= 2;
    case question_t::NUMBER:
      return !m.text.empty() && (m.count == 0 || m.count == 2) && sane(m.lowest) && sane(m.highest) &&
             m.lowest < m.highest && m.step > 0 && m.step <= m.highest - m.lowest;
    default: return false;
  }
}

bool valid(const answer_t& m) {
  return sane(m.header) && m.id > 0 && between(m.choice, -1, 8) && sane(m.number) && m.after_ns >= 0 && name(m.by);
}
}  // namespace tactus
