#include "sync/presentation/node_activity.h"

#include <tactus/node_health_t.hpp>

#include <algorithm>
#include <iterator>

namespace tactus::sync {

bool NodeActivity::observe(std::int64_t incarnation, std::int8_t state, HostTime sent) {
  const bool has_output = state != node_health_t::WAITING && state != node_health_t::OUTPUT_LOST;
  const bool first = spans_.empty();
  const bool same = !first && spans_.back().incarnation == incarnation;
  if (!first && sent < spans_.back().end) return false;  // overtaken
  const bool returned = same && sent - spans_.back().end > kStall;
  if (same && !returned && spans_.back().has_output == has_output) {
    spans_.back().end = sent;
  } else {
    Span next{incarnation, has_output, same ? spans_.back().expected_from : HostTime::max(), sent, sent};
    spans_.push_back(next);
  }
  Span& now = spans_.back();
  // A node whose output cannot be opened has the scene: its events count, as dead.
  const bool ready = state == node_health_t::READY || state == node_health_t::OUTPUT_LOST;
  if ((ready || state == node_health_t::RUNNING || state == node_health_t::STALE) &&
      now.expected_from == HostTime::max()) {
    now.expected_from = ready ? sent : sent + kGrace;
    first_expected_from_ = std::min(first_expected_from_, now.expected_from);
  }
  while (spans_.size() > 1 && sent - spans_[1].begin > kRemember) spans_.pop_front();
  return returned;
}

NodeActivity::Result NodeActivity::during(HostTime from, HostTime to, HostTime now) const {
  if (from < first_expected_from_) return {State::kAbsent, false};
  const auto after = std::find_if(spans_.begin(), spans_.end(), [&](const Span& s) { return s.begin > from; });
  if (after == spans_.begin()) return {State::kDead, false};  // before the stored history
  for (auto span = std::prev(after);; ++span) {
    if (!span->has_output || from < span->expected_from) return {State::kDead, false};
    if (to <= span->end) return {State::kAlive, false};
    const auto next = std::next(span);
    if (next == spans_.end()) {
      if (now - span->end > kDeath) return {State::kDead, true};
      return {State::kUndecided, false};
    }
    if (next->incarnation != span->incarnation) return {State::kDead, false};
    if (next->begin - span->end > kStall) return {State::kStalled, false};
    // Only its ability changed, without an interruption.
    if (next->begin > to && next->has_output) return {State::kAlive, false};
  }
}

bool NodeActivity::died_before(std::int64_t incarnation, HostTime until, HostTime now) const {
  const auto last =
      std::find_if(spans_.rbegin(), spans_.rend(), [&](const Span& s) { return s.incarnation == incarnation; });
  if (last == spans_.rend() || last->end >= until) return false;
  return last != spans_.rbegin() || now - last->end > kDeath;
}

bool NodeActivity::replaced_before(std::int64_t incarnation, HostTime until) const {
  const auto last = std::find_if(spans_.rbegin(), spans_.rend(), [&](const Span& s) { return s.incarnation == incarnation; });
  return last != spans_.rend() && last != spans_.rbegin() && std::prev(last)->begin < until;
}

}  // namespace tactus::sync
