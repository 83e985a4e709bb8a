#include "sync/time/phases.h"

namespace tactus::sync {

thread_local constinit Phases* ScopedPhaseTimer::current = nullptr;

const char* name(Phase phase) {
  constexpr std::array names{"other", "decode", "collision", "solve", "integrate", "render"};
  static_assert(names.size() == kPhases);
  return names[static_cast<std::size_t>(phase)];
}

void Phases::begin(bool measured) {
  ScopedPhaseTimer::current = measured ? this : nullptr;
  if (!measured) return;
  spent_.fill({});
  now_ = Phase::kOther;
  since_ = clock_();
}

void Phases::end() {
  if (ScopedPhaseTimer::current != this) return;
  enter(Phase::kOther);
  ScopedPhaseTimer::current = nullptr;
  for (std::size_t i = 0; i < kPhases; ++i) last_us_[i] = static_cast<double>(spent_[i].count()) / 1000;
}

Phase Phases::enter(Phase phase) {
  const HostTime t = clock_();
  spent_[static_cast<std::size_t>(now_)] += t - since_;
  since_ = t;
  const Phase before = now_;
  now_ = phase;
  return before;
}

}  // namespace tactus::sync
