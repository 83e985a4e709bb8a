#include "sync/playout/comparison.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace tactus::sync {
namespace {

Nanoseconds quantile(std::vector<Nanoseconds>& values, double q) {
  if (values.empty()) return Nanoseconds(0);
  const auto at = static_cast<std::ptrdiff_t>(std::ceil(q * static_cast<double>(values.size()))) - 1;
  const auto nth = values.begin() + std::max<std::ptrdiff_t>(0, at);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace

AlignerResult simulate_aligner(const std::vector<TraceEvent>& trace, AlignerKind kind, Nanoseconds fixed,
                              std::size_t learn) {
  std::map<std::string, std::unique_ptr<Aligner>> aligners;
  AlignerResult result;
  std::vector<Nanoseconds> asynchronies;
  double added_ns = 0;
  std::int64_t presented = 0, late = 0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    Nanoseconds delay{0};
    for (const auto& [sense, aligner] : aligners) delay = std::max(delay, aligner->delay());
    if (i >= learn && !trace[i].empty()) {
      Nanoseconds first = Nanoseconds::max(), last{0};
      for (const auto& [sense, needed] : trace[i]) {
        const Nanoseconds at = std::max(delay, needed);
        first = std::min(first, at), last = std::max(last, at);
        added_ns += static_cast<double>((at - needed).count());
        late += needed > delay;
        ++presented;
      }
      asynchronies.push_back(last - first);
      ++result.events;
    }
    for (const auto& [sense, needed] : trace[i]) {
      auto& aligner = aligners[sense];
      if (!aligner) aligner = make_aligner(kind, fixed);
      aligner->add(needed);
    }
    result.delay_last = delay;
  }
  result.asynchrony_p50 = quantile(asynchronies, 0.5);
  result.asynchrony_p95 = quantile(asynchronies, 0.95);
  if (presented > 0) {
    result.added_mean = Nanoseconds(std::llround(added_ns / static_cast<double>(presented)));
    result.late_share = static_cast<double>(late) / static_cast<double>(presented);
  }
  return result;
}

}  // namespace tactus::sync
