#include "sync/tools/spy/arrivals.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::sync::spy {
namespace {

double of_sorted(const std::vector<double>& sorted, double share) {
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
}

}  // namespace

void Arrivals::add(HostTime arrival, std::size_t bytes) {
  kept_.push_back({arrival, static_cast<std::uint32_t>(bytes)});
  if (kept_.size() > kMax) kept_.pop_front();
}

std::size_t Arrivals::first(HostTime now) const {
  const auto it =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.arrival >= now - kSpan; });
  return static_cast<std::size_t>(it - kept_.begin());
}

// From message to message, so that a slow sender has its true rate, and the rate of a silent one fades.
double Arrivals::rate_Hz(HostTime now) const {
  const std::size_t from = first(now);
  if (kept_.size() < from + 2) return 0;
  const Nanoseconds between = kept_.back().arrival - kept_[from].arrival;
  const auto n = static_cast<double>(kept_.size() - from - 1);
  // The next message is overdue: the time since the newest counts, too.
  const double since = to_seconds(now - kept_.back().arrival), period = to_seconds(between) / n;
  return n / (to_seconds(between) + std::max(0.0, since - period) + 1e-12);
}

double Arrivals::bytes_per_s(HostTime now) const {
  const std::size_t from = first(now);
  if (kept_.size() <= from) return 0;
  double bytes = 0;
  for (std::size_t i = from; i < kept_.size(); ++i) bytes += kept_[i].bytes;
  return bytes / static_cast<double>(kept_.size() - from) * rate_Hz(now);
}

Arrivals::Jitter Arrivals::jitter(HostTime now) const {
  const std::size_t from = first(now);
  if (kept_.size() < from + 3) return {};
  std::vector<double> ms;
  for (std::size_t i = from + 1; i < kept_.size(); ++i)
    ms.push_back(to_seconds(kept_[i].arrival - kept_[i - 1].arrival) * 1000);
  std::sort(ms.begin(), ms.end());
  const double middle = of_sorted(ms, 0.5);
  for (double& x : ms) x = std::abs(x - middle);
  std::sort(ms.begin(), ms.end());
  return {of_sorted(ms, 0.5), of_sorted(ms, 0.99)};
}

}  // namespace tactus::sync::spy
