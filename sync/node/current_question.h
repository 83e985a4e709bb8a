// Which question of a study is asked now: of the messages of all who might lead one (lcmtypes/types/control/question_t.lcm). Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/question_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

class CurrentQuestion {
 public:
  static constexpr Nanoseconds kGone{2'000'000'000};  // question_t.lcm

  // run_id: questions of another run are not heeded; 0: those of any are, as in a log.
  explicit CurrentQuestion(std::int64_t run_id) : run_id_(run_id) {}

  // The newest of one leader holds: false when it is of another run, was overtaken by a newer one, or comes from
  // somebody else while one leads.
  bool push(const question_t& m, HostTime arrival) {
    if (run_id_ != 0 && m.header.run_id != run_id_) return false;
    if (led(arrival)) {
      if (m.header.source != newest_->header.source) return false;
      if (m.header.incarnation == newest_->header.incarnation && m.header.seq <= newest_->header.seq) return false;
    }
    newest_ = m, arrival_ = arrival;
    return true;
  }
  void clear() { newest_.reset(); }

  // What was said last, also that NOTHING is asked; null: nobody leads a study.
  const question_t* led(HostTime now) const { return newest_ && now - arrival_ <= kGone ? &*newest_ : nullptr; }

 private:
  std::int64_t run_id_;
  std::optional<question_t> newest_;
  HostTime arrival_{};
};

// One question apart from all others, whoever leads: ids begin anew with a leader that is started anew.
struct QuestionKey {
  std::int64_t incarnation = 0, id = 0;
  bool operator==(const QuestionKey&) const = default;
};
inline QuestionKey key_of(const question_t& m) { return {m.header.incarnation, m.id}; }

}  // namespace tactus::sync
