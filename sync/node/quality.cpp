#include "sync/node/quality.h"

#include <algorithm>

namespace tactus::sync {

QualityLadder::QualityLadder(int steps, Nanoseconds budget, int calm_ticks)
    : steps_(std::clamp(steps, 1, kMaxSteps)), budget_(budget), calm_ticks_(std::max(calm_ticks, 1)) {
  ratio_.fill(1);
}

void QualityLadder::start(std::span<const Nanoseconds> costs) {
  const std::size_t known = std::min(costs.size(), static_cast<std::size_t>(steps_));
  std::size_t step = 0;
  while (step + 1 < known && too_long(costs[step])) ++step;
  for (std::size_t i = 0; i + 1 < known; ++i)
    ratio_[i] = std::max(1.0, to_seconds(costs[i]) / std::max(to_seconds(costs[i + 1]), 1e-9));
  switch_to(static_cast<int>(step));
}

void QualityLadder::add(Nanoseconds used) {
  used_[count_ % kWindow] = used;
  ++count_;
  if (on_trial_ > 0 && ++on_trial_ > kTrial * calm_ticks_) {
    doublings_ = std::max(doublings_ - 1, 0);
    on_trial_ = doublings_ > 0 ? 1 : 0;
  }
  if (count_ < kMinTicks) return;
  if (count_ == kMinTicks) measure_cost();
  if (step_ + 1 < steps_ && overloaded()) {
    if (on_trial_ > 0) doublings_ = std::min(doublings_ + 1, kMaxDoublings);
    on_trial_ = 0;
    left_at_[static_cast<std::size_t>(step_)] = quartile(3);
    switch_to(step_ + 1);
  } else if (step_ > 0) {
    postpone_trial();
  }
}

// Stores the cost of the abandoned step relative to the cost of the current step.
void QualityLadder::measure_cost() {
  if (step_ == 0) return;
  const auto better = static_cast<std::size_t>(step_ - 1);
  if (left_at_[better] <= Nanoseconds(0)) return;
  ratio_[better] = std::max(1.0, to_seconds(left_at_[better]) / std::max(to_seconds(quartile(3)), 1e-9));
  left_at_[better] = Nanoseconds(0);
}

void QualityLadder::postpone_trial() {
  const double share = to_seconds(quartile(3)) / to_seconds(budget_);
  fits_ = share * ratio_[static_cast<std::size_t>(step_ - 1)] <= kLow ? fits_ + 1 : 0;
  spare_ = share <= kLow ? spare_ + 1 : 0;
  const int wait = calm_ticks_ << doublings_;
  if (fits_ < wait && spare_ < kTryAfter * wait) return;
  switch_to(step_ - 1);
  on_trial_ = 1;
}

void QualityLadder::switch_to(int to) {
  step_ = to;
  count_ = 0;
  fits_ = spare_ = 0;
}

bool QualityLadder::too_long(Nanoseconds used) const { return to_seconds(used) > kHigh * to_seconds(budget_); }

bool QualityLadder::overloaded() const { return too_long(quartile(count_ < kWindow ? 2 : 3)); }

Nanoseconds QualityLadder::quartile(std::size_t quarters) const {
  auto sorted = used_;
  const std::size_t n = std::min(count_, kWindow), at = n * quarters / 4;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at),
                   sorted.begin() + static_cast<std::ptrdiff_t>(n));
  return sorted[at];
}

}  // namespace tactus::sync
