#include "sync/playout/latency_demand.h"

#include <algorithm>

namespace tactus::sync {

void LatencyDemand::set_plan(const PlayoutPlan& plan) {
  plan_ = plan;
  for (auto& [name, entry] : modalities_) {
    entry.aligner = make_aligner(plan_.aligner, plan_.base);
    for (const Nanoseconds needed : entry.last)
      if (is_usable(needed)) entry.aligner->add(needed);
  }
}

// In a serial loop every modality waits for the one before, without a limit.
bool LatencyDemand::is_usable(Nanoseconds needed) const {
  return needed <= plan_.budget || plan_.policy == Policy::kItouch2005;
}

LatencyDemand::Modality* LatencyDemand::find_or_add(const std::string& modality) {
  const auto it = modalities_.find(modality);
  if (it != modalities_.end()) return &it->second;
  if (modalities_.size() >= kMaxModalities) return nullptr;
  Modality& entry = modalities_[modality];
  entry.aligner = make_aligner(plan_.aligner, plan_.base);
  return &entry;
}

void LatencyDemand::add_modality(const std::string& modality, bool slow) {
  if (find_or_add(modality) == nullptr) return;
  if (slow)
    slow_.insert(modality);
  else
    slow_.erase(modality);
}

void LatencyDemand::add(const std::string& modality, Nanoseconds needed) {
  Modality* entry = find_or_add(modality);
  if (entry == nullptr) return;
  needed = std::max(needed, Nanoseconds(0));
  entry->last.push_back(needed);
  if (entry->last.size() > kRemembered) entry->last.pop_front();
  if (is_usable(needed)) entry->aligner->add(needed);
}

std::optional<Nanoseconds> LatencyDemand::needed(const std::string& modality) const {
  const auto it = modalities_.find(modality);
  if (it == modalities_.end() || it->second.last.empty()) return std::nullopt;
  const auto& last = it->second.last;
  const auto recent = last.end() - static_cast<std::ptrdiff_t>(std::min(kRecent, last.size()));
  const auto unusable = std::count_if(recent, last.end(), [&](Nanoseconds n) { return !is_usable(n); });
  if (2 * unusable > last.end() - recent) return *std::max_element(recent, last.end());
  return it->second.aligner->delay();
}

std::map<std::string, Nanoseconds> LatencyDemand::latencies() const {
  std::map<std::string, Nanoseconds> all;
  for (const auto& [name, entry] : modalities_) all[name] = needed(name).value_or(Nanoseconds(0));
  return all;
}

}  // namespace tactus::sync
