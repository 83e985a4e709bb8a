#include "sync/degradation/stage_signal.h"

#include <algorithm>

#include "sync/random/keyed_random.h"

namespace tactus::sync {
namespace {

constexpr std::uint64_t kSignalStream = 0x3000;  // beside the streams of snapshot.cpp

}  // namespace

void StageSignal::Receiver::add(SimTime t, const PendingSample& sent) {
  force_N.add(t, sent.sample.force_N);
  torque_N_m.add(t, sent.sample.torque_N_m);
  transient_N.add(t, sent.sample.transient_N);
  last = sent.sample;
  release = sent.release;
}

ForceSample StageSignal::Receiver::at(SimTime t) const {
  ForceSample sample = last;
  sample.force_N = force_N.at(t);
  sample.torque_N_m = torque_N_m.at(t);
  sample.transient_N = transient_N.at(t);
  return sample;
}

void StageSignal::clear() {
  waiting_.clear();
  delivered_ = {};
  receiver_ = {};
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
    receiver_ = {};
    return delivered_ = sample;
  }
  const StreamItem item{.key = key,
                        .stream = kSignalStream,
                        .time = world,
                        .arrival = now,
                        .publish_ns = to_ns(now),
                        .paced = world,
                        .signals = {},
                        .speed_m_s = sample.speed_m_s};
  PendingSample next{now, sample};
  Decision decision = operators.decide(item, next.sample);
  const DeadbandDef* const deadband = operators.deadband(world);
  const bool predicts = deadband && deadband->predictor == Predictor::kLinear;
  bool predicted = false;
  // The sender begins without a line, too: under a new profile, and after a restart of the world.
  if (!predicts || decision.begins_prediction) receiver_ = {};
  if (!decision.dropped()) {
    decision.release = std::max(now, decision.release + decision.shift + operators.presentation_delay(world));
    decision.shift = Nanoseconds(0);
    next.release = decision.release;
    if (predicts) receiver_.add(world, next);
  } else if (predicts && !receiver_.force_N.empty() && decision.conceal == Conceal::kHold && decision.why != DropReason::kFreeze) {
    // As late as the samples that are sent, and never before the newest of them.
    next.sample = receiver_.at(world);
    next.release = std::max(now + operators.constant_delay(world), receiver_.release);
    predicted = true;
  } else {
    // A replacement by zero is as late as the sample that it replaces.
    next.sample = {};
    next.release = now + operators.constant_delay(world);
  }
  if (!decision.dropped() || predicted || decision.conceal == Conceal::kZero) waiting_.push_back(next);
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
