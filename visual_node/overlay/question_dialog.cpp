#include "visual_node/overlay/question_dialog.h"

#include <algorithm>
#include <cmath>

namespace tactus::visual {

void QuestionDialog::push(const question_t& m, sync::HostTime arrival) {
  if (!current_.push(m, arrival)) return;
  if (const answer_t* known = answered(m))
    to_send_ = *known;
  else if (key_ != sync::key_of(m))
    begin(m);
}

void QuestionDialog::begin(const question_t& m) {
  key_ = sync::key_of(m);
  presented_.reset();
  to_send_.reset();
  lowest_ = m.lowest, highest_ = m.highest, step_ = m.step;
  steps_ = mark_ = 0;
  if (m.kind != question_t::NUMBER) return;
  // The last step may be shorter, so that both ends can be selected.
  steps_ = std::ceil((m.highest - m.lowest) / m.step - 1e-9);
  if (!(steps_ <= kMaxSteps)) steps_ = kMaxSteps, step_ = (m.highest - m.lowest) / kMaxSteps;
  mark_ = std::floor(steps_ / 2);
}

const answer_t* QuestionDialog::answered(const question_t& m) const {
  const auto found = std::find_if(answered_.begin(), answered_.end(),
                                  [&](const Answered& a) { return a.key == sync::key_of(m); });
  return found == answered_.end() ? nullptr : &found->answer;
}

const question_t* QuestionDialog::current(sync::HostTime now) const {
  const question_t* m = current_.newest(now);
  return m && m->kind != question_t::NOTHING && !answered(*m) ? m : nullptr;
}

double QuestionDialog::number() const { return std::min(lowest_ + mark_ * step_, highest_); }

void QuestionDialog::set_presented(sync::HostTime at) {
  if (key_ && !presented_) presented_ = at;
}

bool QuestionDialog::press(const QuestionInput& press, const char* by, sync::HostTime now) {
  if (!study_running(now)) return false;
  const question_t* m = current(now);
  if (!m || !presented_) return true;
  switch (m->kind) {
    case question_t::READ:
      if (press.continues) answer(*m, by, now, -1);
      break;
    case question_t::CHOICE:
      if (press.choice >= 0 && press.choice < m->count) answer(*m, by, now, press.choice);
      break;
    case question_t::NUMBER: {
      const double coarse = std::max(1.0, std::round(steps_ * kCoarseShare));
      mark_ = std::clamp(mark_ + press.fine + press.coarse * coarse, 0.0, steps_);
      if (press.confirms) answer(*m, by, now, -1);
      break;
    }
    default: break;
  }
  return true;
}

void QuestionDialog::answer(const question_t& m, const char* by, sync::HostTime now, int choice) {
  answer_t a{};
  a.header.sim_time_ns = -1;
  a.id = m.id;
  a.choice = choice;
  a.number = m.kind == question_t::NUMBER ? number() : 0;
  a.after_ns = std::max(sync::Nanoseconds(0), now - *presented_).count();
  a.by = by;
  answered_.push_back({sync::key_of(m), a});
  if (answered_.size() > kMaxAnswers) answered_.pop_front();
  to_send_ = a;
}

}  // namespace tactus::visual
