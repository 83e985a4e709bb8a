// Question messages as a trial runner sends them.
#pragma once

#include <chrono>
#include <string>
#include <tactus/question_t.hpp>
#include <vector>

#include "sync/time/time.h"
#include "tests/times.h"

namespace tactus::test {

inline question_t question(std::int64_t id, int kind, std::int64_t seq = 0, std::int64_t incarnation = 1) {
  question_t m{};
  m.header.sim_time_ns = -1;
  m.header.run_id = 7, m.header.source = 3, m.header.incarnation = incarnation, m.header.seq = seq;
  m.id = id;
  m.kind = static_cast<std::int8_t>(kind);
  if (kind != question_t::NOTHING) m.text = "Was the sound at the same time as the flash?";
  return m;
}
inline question_t choice(std::int64_t id, std::vector<std::string> choices, std::int64_t seq = 0) {
  question_t m = question(id, question_t::CHOICE, seq);
  m.count = static_cast<std::int32_t>(choices.size());
  m.choices = std::move(choices);
  return m;
}
inline question_t number(std::int64_t id, double lowest, double highest, double step, std::int64_t seq = 0) {
  question_t m = question(id, question_t::NUMBER, seq);
  m.lowest = lowest, m.highest = highest, m.step = step;
  return m;
}

}  // namespace tactus::test
