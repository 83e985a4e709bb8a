#include "scripts/trial_runner/enforcement.h"

namespace tactus::trial_runner {

void Enforcement::push(const node_health_t& m, sync::HostTime arrival) {
  if (m.modality.empty() || (modalities_.size() >= kMaxModalities && !modalities_.contains(m.node))) return;
  modalities_[m.node] = {m.profile, arrival};
}

const sync::ProfileInForce* Enforcement::to_send(sync::HostTime now) {
  if (!profile_ || confirmed_ || (next_ && now < *next_)) return nullptr;
  next_ = now + kRepeat;
  return &*profile_;
}

std::vector<std::string> Enforcement::missing(sync::HostTime now) const {
  std::vector<std::string> names;
  for (const auto& [name, node] : modalities_)
    if (profile_ && now - node.received <= kHealthTimeout && node.profile != profile_->hash) names.push_back(name);
  return names;
}

std::optional<std::vector<std::string>> Enforcement::take_in_force(sync::HostTime now) {
  if (!profile_ || confirmed_ || !missing(now).empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& [name, node] : modalities_)
    if (now - node.received <= kHealthTimeout) names.push_back(name);
  if (names.empty()) return std::nullopt;
  confirmed_ = true;
  return names;
}

}  // namespace tactus::trial_runner
