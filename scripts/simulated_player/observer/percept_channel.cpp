#include "scripts/simulated_player/observer/percept_channel.h"

#include <algorithm>
#include <cmath>

namespace tactus::observer {

void PerceptChannel::present(double presented_s, const Eigen::Vector3d& value, double sd) {
  if (!std::isfinite(presented_s) || !value.allFinite()) return;
  const SensedValue percept{presented_s + latency_s_, value, sd};
  const auto after = std::upper_bound(waiting_.begin(), waiting_.end(), percept.arrival_s,
                                      [](double at, const SensedValue& p) { return at < p.arrival_s; });
  waiting_.insert(after, percept);
  if (waiting_.size() > capacity_) waiting_.pop_front();
}

std::optional<SensedValue> PerceptChannel::take(double now_s) {
  if (waiting_.empty() || waiting_.front().arrival_s > now_s) return std::nullopt;
  const SensedValue percept = waiting_.front();
  waiting_.pop_front();
  return percept;
}

}  // namespace tactus::observer
