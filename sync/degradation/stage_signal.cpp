#include "sync/degradation/stage_signal.h"

#include <algorithm>
#include <array>

#include "sync/random/keyed_random.h"

namespace tactus::sync {
namespace {

constexpr std::uint64_t kSignalStream = 0x3000;  // beside the streams of snapshot.cpp

}  // namespace

void StageSignal::clear() {
  waiting_.clear();
  delivered_ = {};
}

std::uint64_t StageSignal::next_key(SimTime world) {
  repeats_ = world == world_ ? repeats_ + 1 : 0;
  world_ = world;
  return mixed(static_cast<std::uint64_t>(to_ns(world)), repeats_);
}

const ForceSample& StageSignal::step(HostTime now, SimTime world, const ForceSample& sample, OperatorChain& operators,
                                     Decisions* decisions) {
  const std::uint64_t key = next_key(world);
  if (operators.empty()) {
    waiting_.clear();
    return delivered_ = sample;
  }
  const std::array<Signal, 1> signals{{{0, Quantity::kForce, sample.force_N}}};
  StreamItem item{.key = key,
                  .stream = kSignalStream,
                  .time = world,
                  .arrival = now,
                  .publish_ns = to_ns(now),
                  .paced = world,
                  .signals = signals};
  Decision decision = operators.decide(item);
  PendingSample next{now, sample};
  if (!decision.dropped()) {
    operators.degrade_force(next.sample, world);
    decision.release = std::max(now, decision.release + decision.shift + operators.presentation_delay(world));
    decision.shift = Nanoseconds(0);
    next.release = decision.release;
  } else {
    // A replacement by zero is as late as the sample that it replaces.
    next.sample = {};
    next.release = now + operators.constant_delay(world);
  }
  if (!decision.dropped() || decision.conceal == Conceal::kZero) waiting_.push_back(next);
  if (decisions && decision.evaluated) decisions->push_back({key, false, world, decision, now, kSignalStream});
  if (waiting_.size() > kMaxWaiting) waiting_.erase(waiting_.begin());
  for (auto due = waiting_.end(); due != waiting_.begin();)
    if ((--due)->release <= now) {
      delivered_ = due->sample;
      waiting_.erase(waiting_.begin(), due + 1);
      break;
    }
  return delivered_;
}

}  // namespace tactus::sync
