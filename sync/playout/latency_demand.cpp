#include "sync/playout/latency_demand.h"

#include <algorithm>

namespace tactus::sync {

void LatencyDemand::set_plan(const PlayoutPlan& plan) {
  plan_ = plan;
  for (auto& [name, sense] : senses_) {
    sense.aligner = make_aligner(plan_.aligner, plan_.base);
    for (const Nanoseconds needed : sense.last)
      if (counts(needed)) sense.aligner->add(needed);
  }
}

// In a serial loop every modality waits for the one before, without a limit.
bool LatencyDemand::counts(Nanoseconds needed) const {
  return needed <= plan_.budget || plan_.policy == Policy::kItouch2005;
}

LatencyDemand::ModalityEndpoint* LatencyDemand::of(const std::string& modality) {
  const auto it = senses_.find(modality);
  if (it != senses_.end()) return &it->second;
  if (senses_.size() >= kMaxSenses) return nullptr;
  ModalityEndpoint& sense = senses_[modality];
  sense.aligner = make_aligner(plan_.aligner, plan_.base);
  return &sense;
}

void LatencyDemand::know(const std::string& modality, bool slow) {
  if (of(modality) == nullptr) return;
  if (slow)
    slow_.insert(modality);
  else
    slow_.erase(modality);
}

void LatencyDemand::add(const std::string& modality, Nanoseconds needed) {
  ModalityEndpoint* sense = of(modality);
  if (sense == nullptr) return;
  needed = std::max(needed, Nanoseconds(0));
  sense->last.push_back(needed);
  if (sense->last.size() > kRemembered) sense->last.pop_front();
  if (counts(needed)) sense->aligner->add(needed);
}

std::optional<Nanoseconds> LatencyDemand::needed(const std::string& modality) const {
  const auto it = senses_.find(modality);
  if (it == senses_.end() || it->second.last.empty()) return std::nullopt;
  const auto& last = it->second.last;
  const auto lately = last.end() - static_cast<std::ptrdiff_t>(std::min(kLately, last.size()));
  const auto beyond = std::count_if(lately, last.end(), [&](Nanoseconds n) { return !counts(n); });
  if (2 * beyond > last.end() - lately) return *std::max_element(lately, last.end());
  return it->second.aligner->delay();
}

std::map<std::string, Nanoseconds> LatencyDemand::all() const {
  std::map<std::string, Nanoseconds> all;
  for (const auto& [name, sense] : senses_) all[name] = needed(name).value_or(Nanoseconds(0));
  return all;
}

}  // namespace tactus::sync
