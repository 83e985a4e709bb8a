// Validation of requests and their replies: settings, tags, and the questions of a study.
#include <algorithm>
#include <cmath>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "lcmtypes/page_limits.h"
#include "lcmtypes/plausible.h"
#include "lcmtypes/utf8.h"
#include "lcmtypes/valid.h"

namespace tactus {

bool valid(const setting_change_t& m) {
  return sane(m.header) && m.id > 0 && name(m.node) && name(m.name) && m.value.size() <= 256 && printable(m.value);
}
bool valid(const setting_reply_t& m) {
  return sane(m.header) && m.id > 0 && between(m.done, 0, 1) && m.text.size() <= 512;
}
bool valid(const tag_list_t& m) {
  const auto tag = [](const tag_def_t& t) {
    return name(t.name) && t.name.size() <= 48 && name(t.unit) && t.unit.size() <= 16 &&
           sane_not_negative(t.rate_Hz);
  };
  return sane(m.header) && name(m.node) && m.list > 0 && between(m.total, 0, 1024) && m.first >= 0 &&
         m.tag_count >= 0 && m.first + m.tag_count <= m.total && std::all_of(m.tags.begin(), m.tags.end(), tag);
}
bool valid(const tag_request_t& m) {
  const auto pattern = [](const std::string& p) { return !p.empty() && p.size() <= 128 && printable(p); };
  return sane(m.header) && between(m.pattern_count, 0, 16) &&
         std::all_of(m.patterns.begin(), m.patterns.end(), pattern);
}
bool valid(const tag_values_t& m) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return sane(m.header) && name(m.node) && m.list > 0 && between(m.column_count, 1, 128) &&
         between(m.row_count, 1, 128) && m.value_count == m.column_count * m.row_count &&
         std::all_of(m.columns.begin(), m.columns.end(), [](int c) { return between(c, 0, 1023); }) &&
         std::all_of(m.times_ns.begin(), m.times_ns.end(), [](long t) { return clock_time(t); }) &&
         std::is_sorted(m.times_ns.begin(), m.times_ns.end()) &&
         std::all_of(m.values.begin(), m.values.end(), finite);
}

bool valid(const question_t& m) {
  const auto line = [](const std::string& l, std::size_t most) { return is_text_line(l) && character_count(l) <= most; };
  const auto choice = [&](const std::string& c) { return !c.empty() && line(c, 40); };
  if (!sane(m.header) || m.id <= 0 || !line(m.text, 600) || !between(m.count, 0, 9) ||
      !std::ranges::all_of(m.choices, choice) || m.trial < 0 || !line(m.condition, 64) || !line(m.progress, 64) ||
      !line(m.hint, 64) || !between(m.pages, 0, kMaxQuestionPages) || m.page < 0 || m.page >= std::max(1, m.pages))
    return false;
  // A part of a question. The whole is validated when all parts have arrived (sync/node/question_pages.h).
  if (m.pages > 1) return between(m.kind, question_t::READ, question_t::NUMBER) && sane(m.lowest) && sane(m.highest) && sane(m.step);
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
