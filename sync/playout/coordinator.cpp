#include "sync/playout/coordinator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tactus/playout_entry_t.hpp>
#include <utility>

#include "sync/playout/exchange.h"

namespace tactus::sync {
namespace {

// True when the delays come from the measured needs of the modalities.
bool estimated(const PlayoutPlan& plan) {
  return (plan.policy == Policy::kAligned || plan.policy == Policy::kLocalHapticFirst) &&
         plan.aligner != AlignerKind::kFixed;
}

}  // namespace

PlayoutCoordinator::PlayoutCoordinator(std::int64_t own_clock, PlayoutPlan plan)
    : own_clock_(own_clock), plan_(std::move(plan)), demand_(plan_) {}

void PlayoutCoordinator::apply_plan(std::int64_t generation, PlayoutPlan plan) {
  generation_ = generation;
  plan_ = std::move(plan);
  demand_.set_plan(plan_);
  published_.clear();
  next_ = {};
}

bool PlayoutCoordinator::push(const playout_request_t& m) {
  if (m.generation <= generation_) return false;
  PlayoutPlan plan = plan_of(m);
  try {
    plan.check();
  } catch (const std::invalid_argument&) {
    return false;  // the requesting program has checked it, so this request is forged
  }
  apply_plan(m.generation, std::move(plan));
  return true;
}

void PlayoutCoordinator::push(const playout_t& m, HostTime now) {
  if (m.header.clock == own_clock_) return;
  if (m.header.clock < own_clock_) other_published_ = now;
  if (m.generation > generation_) apply_plan(m.generation, plan_of(m));
  // A plan may have several pages, and the page with the asynchronies may arrive later.
  if (m.generation == generation_ && m.header.clock < own_clock_ && plan_.policy == Policy::kExperiment)
    plan_.soa.merge(plan_of(m).soa);
}

Nanoseconds PlayoutCoordinator::with_hysteresis(const std::string& modality, Nanoseconds delay) {
  const auto [it, first] = published_.try_emplace(modality, delay);
  const Nanoseconds change = delay - it->second;
  if (!estimated(plan_) || change > Nanoseconds(0) || change < -kSlack) it->second = delay;
  return it->second;
}

std::optional<playout_t> PlayoutCoordinator::next_message(HostTime now) {
  if (now < next_ || (other_published_ && now - *other_published_ < kSilent)) return std::nullopt;
  next_ = now - next_ < kPeriod ? next_ + kPeriod : now + kPeriod;
  playout_t m{};
  write_plan(m, generation_, plan_);
  const auto needed = demand_.latencies();
  // Before any need is known, each modality keeps its own delay.
  const bool known =
      std::any_of(needed.begin(), needed.end(), [&](const auto& n) { return demand_.needed(n.first).has_value(); });
  // A new rate would shift the phase of the loop: small changes are ignored.
  const double rate_Hz = lockstep_rate_Hz(plan_, needed);
  if (rate_Hz == 0 || std::abs(rate_Hz - lockstep_Hz_) > kLockstepSlack * lockstep_Hz_) lockstep_Hz_ = rate_Hz;
  m.lockstep_Hz = lockstep_Hz_;
  for (const auto& [name, delay] : playout_delays(plan_, needed, demand_.slow())) {
    if (estimated(plan_) && !known) break;
    playout_entry_t e{};
    e.modality = name;
    e.delay_ns = with_hysteresis(name, delay).count();
    const auto soa = plan_.soa.find(name);
    e.soa_ns = soa == plan_.soa.end() ? 0 : soa->second.count();
    const auto need = demand_.needed(name);
    e.needs_ns = need ? std::min(need->count(), std::int64_t{60'000'000'000}) : -1;
    m.entries.push_back(std::move(e));
  }
  m.count = static_cast<std::int32_t>(m.entries.size());
  return m;
}

}  // namespace tactus::sync
