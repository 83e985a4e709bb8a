// A force signal at a stage of touch: one computed sample a tick in, the delivered sample out. The newest sample that is due
// holds until the next one; an older one never follows a newer one. A deadband with predict=linear instead continues the line
// through the last two samples that it sent, in the time of the sender. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sync/degradation/decision_record.h"
#include "sync/degradation/operator_chain.h"
#include "sync/time/time.h"

namespace tactus::sync {

class StageSignal {
 public:
  // Samples that wait at most: a second at 4 kHz, the largest delay of a stage in a servo loop. When it is full, the oldest is
  // dropped.
  static constexpr std::size_t kMaxWaiting = 4096;

  StageSignal() { waiting_.reserve(kMaxWaiting + 1); }

  // One tick. now: on the clock of the caller, never decreasing; world: simulated time of the tick, for from= and until=.
  // decisions: list to which the decision is appended; null: none. Without operators, or with a delay of 0, it returns the
  // sample itself. Realtime-safe: yes, except for the first tick of a profile.
  const ForceSample& step(HostTime now, SimTime world, const ForceSample& sample, OperatorChain& operators,
                          Decisions* decisions = nullptr);
  const ForceSample& delivered() const { return delivered_; }
  // Clears all samples: the delivered force is zero.
  void clear();

 private:
  struct PendingSample {
    HostTime release;
    ForceSample sample;
  };
  // A key for the random numbers of this sample: the world may stand still for many ticks.
  std::uint64_t next_key(SimTime world);

  // The receiver of a deadband that predicts: the samples that were sent, part by part.
  struct Receiver {
    Prediction force_N{Predictor::kLinear}, torque_N_m{Predictor::kLinear}, transient_N{Predictor::kLinear};
    ForceSample last;    // sent last
    HostTime release{};  // of that sample
    void add(SimTime t, const PendingSample& sent);
    ForceSample at(SimTime t) const;
  };

  std::vector<PendingSample> waiting_;  // in the order of their ticks
  Receiver receiver_;
  ForceSample delivered_;
  SimTime world_{SimTime::min()};
  std::uint64_t repeats_ = 0;  // ticks at the same simulated time
};

}  // namespace tactus::sync
