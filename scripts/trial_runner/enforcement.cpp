#include "scripts/trial_runner/enforcement.h"

namespace tactus::trial_runner {

void Enforcement::push(const node_health_t& m, sync::HostTime arrival) {
  if (m.modality.empty() || (senses_.size() >= kMaxSenses && !senses_.contains(m.node))) return;
  senses_[m.node] = {m.profile, arrival};
}

const sync::ProfileInForce* Enforcement::to_send(sync::HostTime now) {
  if (!profile_ || told_ || (next_ && now < *next_)) return nullptr;
  next_ = now + kRepeat;
  return &*profile_;
}

std::vector<std::string> Enforcement::missing(sync::HostTime now) const {
  std::vector<std::string> names;
  for (const auto& [name, sense] : senses_)
    if (profile_ && now - sense.heard <= kForgotten && sense.profile != profile_->hash) names.push_back(name);
  return names;
}

std::optional<std::vector<std::string>> Enforcement::take_in_force(sync::HostTime now) {
  if (!profile_ || told_ || !missing(now).empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& [name, sense] : senses_)
    if (now - sense.heard <= kForgotten) names.push_back(name);
  if (names.empty()) return std::nullopt;
  told_ = true;
  return names;
}

}  // namespace tactus::trial_runner
