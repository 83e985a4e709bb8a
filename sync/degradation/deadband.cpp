#include "sync/degradation/deadband.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::sync {

bool Deadband::send(SimTime t, std::span<const Signal> signals, double speed_m_s) {
  const double dt_s = started_ ? std::max(0.0, to_seconds(t - last_)) : 0;
  const double filter_gain = def_.lowpass_Hz > 0 ? 1 - std::exp(-2 * std::numbers::pi * def_.lowpass_Hz * dt_s) : 1;
  const double fraction = def_.fraction + def_.adaptive_s_m * speed_m_s;
  bool changed = !started_;
  started_ = true;
  last_ = t;
  for (auto& [id, m] : memory_) m.present = false;
  for (const Signal& s : signals) {
    if (s.quantity != def_.quantity) continue;
    const auto [it, fresh] = memory_.try_emplace(s.id, Memory{s.value, s.value, true});
    Memory& m = it->second;
    m.present = true;
    if (!fresh) m.filtered += filter_gain * (s.value - m.filtered);
    changed |= fresh || (m.filtered - m.sent).norm() > std::max(fraction * m.sent.norm(), def_.floor);
  }
  changed |= std::erase_if(memory_, [](const auto& entry) { return !entry.second.present; }) > 0;
  if (changed)
    for (auto& [id, m] : memory_) m.sent = m.filtered;
  return changed;
}

}  // namespace tactus::sync
