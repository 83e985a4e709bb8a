// The question that a study asks now, from the messages of all processes that may lead a study
// (lcmtypes/types/control/question_t.lcm). Pure.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <tactus/question_t.hpp>
#include <utility>

#include "sync/node/question_pages.h"
#include "sync/time/time.h"

namespace tactus::sync {

class CurrentQuestion {
 public:
  static constexpr Nanoseconds kTimeout{2'000'000'000};  // question_t.lcm

  // run_id: questions of other runs are ignored; 0: questions of any run count, as in a log.
  explicit CurrentQuestion(std::int64_t run_id) : run_id_(run_id) {}

  // The newest question of one leader holds. Returns false when the message is of another run, is older than the newest one,
  // comes from a second sender while one leads, or is a page of a question that is not complete yet.
  bool push(const question_t& m, HostTime arrival) {
    if (run_id_ != 0 && m.header.run_id != run_id_) return false;
    if (newest(arrival)) {
      if (m.header.source != newest_->header.source) return false;
      if (m.header.incarnation == newest_->header.incarnation && m.header.seq <= newest_->header.seq) return false;
    }
    auto whole = pages_.push(m);
    if (!whole) return false;
    newest_ = std::move(whole), arrival_ = arrival;
    return true;
  }
  void clear() { newest_.reset(), pages_.clear(); }

  // The newest question, whole, also one of kind NOTHING; null: no process leads a study.
  const question_t* newest(HostTime now) const { return newest_ && now - arrival_ <= kTimeout ? &*newest_ : nullptr; }

 private:
  std::int64_t run_id_;
  QuestionReader pages_;
  std::optional<question_t> newest_;
  HostTime arrival_{};
};

// Identifies a question across leaders: the ids start again when a leader is restarted.
struct QuestionKey {
  std::int64_t incarnation = 0, id = 0;
  auto operator<=>(const QuestionKey&) const = default;
};
inline QuestionKey key_of(const question_t& m) { return {m.header.incarnation, m.id}; }

}  // namespace tactus::sync
