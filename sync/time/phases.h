// Measures the time of each phase of a tick. A scope marks a phase:
//
//   const sync::ScopedPhaseTimer phase(sync::Phase::kCollision);
//
// It costs one comparison while no process requests the times. The measurement belongs to the thread: the loop of a process
// has phases, other threads have none, and a library needs no argument for it and computes the same.
#pragma once

#include <array>
#include <cstddef>

#include "sync/time/time.h"

namespace tactus::sync {

enum class Phase { kOther, kDecode, kCollision, kSolve, kIntegrate, kRender };
inline constexpr std::size_t kPhases = 6;
// "other", "decode", "collision", "solve", "integrate", "render".
const char* name(Phase phase);

class Phases {
 public:
  using Clock = HostTime (*)();
  explicit Phases(Clock clock) : clock_(clock) {}

  // Begins a tick of this thread. measured: the times are requested; otherwise the last results stay.
  void begin(bool measured);
  void end();
  // Duration of a phase in the last measured tick, us.
  const double* us_pointer(Phase phase) const { return &last_us_[static_cast<std::size_t>(phase)]; }

 private:
  friend class ScopedPhaseTimer;
  Phase enter(Phase phase);

  Clock clock_;
  std::array<Nanoseconds, kPhases> spent_{};
  std::array<double, kPhases> last_us_{};
  Phase now_ = Phase::kOther;
  HostTime since_{};
};

class ScopedPhaseTimer {
 public:
  explicit ScopedPhaseTimer(Phase phase) : phases_(current) {
    if (phases_ != nullptr) before_ = phases_->enter(phase);
  }
  ~ScopedPhaseTimer() {
    if (phases_ != nullptr) phases_->enter(before_);
  }
  ScopedPhaseTimer(const ScopedPhaseTimer&) = delete;
  ScopedPhaseTimer& operator=(const ScopedPhaseTimer&) = delete;

 private:
  friend class Phases;
  static thread_local constinit Phases* current;  // null: not measured
  Phases* phases_;
  Phase before_ = Phase::kOther;
};

}  // namespace tactus::sync
