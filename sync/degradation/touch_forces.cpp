#include "sync/degradation/touch_forces.h"

namespace tactus::sync {
namespace {
// A larger fall of simulated time means that the world restarted, as in sync/clocks/sim_clock_tracker.h.
constexpr Nanoseconds kMaxFallBack{1'000'000'000};
}  // namespace

void TouchForces::follow(Contact& contact, const Eigen::Vector3d& impulse_N_s, SimTime t) {
  contact.present = contact.pushed = true;
  if (contact.time - t > kMaxFallBack) contact = {t, impulse_N_s, Eigen::Vector3d::Zero(), true, true};
  if (t <= contact.time) return;
  contact.force_N = (impulse_N_s - contact.impulse_N_s) / to_seconds(t - contact.time);
  contact.time = t;
  contact.impulse_N_s = impulse_N_s;
}

void TouchForces::append(std::vector<Signal>& signals, SimTime t) {
  for (auto& [id, contact] : contacts_) contact.present = contact.pushed = false;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  for (const Signal& s : signals)
    if (s.quantity == Quantity::kImpulse)
      follow(contacts_.try_emplace(s.id, Contact{t, s.value, zero, true, true}).first->second, s.value, t);
  for (const Signal& s : signals) {
    if (s.quantity != Quantity::kPosition) continue;  // of a plane
    Contact& contact = contacts_.try_emplace(s.id, Contact{t, zero, zero, true, false}).first->second;
    contact.present = true;
    if (contact.pushed || t <= contact.time) continue;
    contact.force_N.setZero();
    if (contact.impulse_N_s.isZero(0)) contact.time = t;  // its first impulse will have begun after this model
  }
  std::erase_if(contacts_, [](const auto& entry) { return !entry.second.present; });
  for (const auto& [id, contact] : contacts_) signals.push_back({id, Quantity::kForce, contact.force_N});
}

}  // namespace tactus::sync
