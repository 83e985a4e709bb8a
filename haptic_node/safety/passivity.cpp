#include "haptic_node/safety/passivity.h"

#include <cmath>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Longer than any delay of a touch model before it counts as lost, so that the last reports have arrived.
constexpr double kEpisodeGap_s = 0.2;
// From a tick to the simulation step that applies its force and back, in addition to the age of the touch model: a
// step and a tick.
constexpr double kRoundTrip_s = 0.002;
// Number of entries kept without force. Design: several times the number in a touch model.
constexpr std::size_t kMaxLedgers = 32;
// Dissipated energy counts as credit up to this value, so that old friction does not pay for a new oscillation.
constexpr double kMaxCredit_J = 0.01;
// Refill rate of the allowance: after a violation, touch recovers within seconds.
constexpr double kRefill_W = 0.0002;
// The factor falls to zero within 5 ms at 1 kHz, which keeps a force of 8 N below the slew limit. It recovers
// within a second, slower than any oscillation of hand or body, so that it drives no cycle itself.
constexpr double kFall_1_s = 200, kRise_1_s = 1;
// The same limits as in safety.cpp, faster than any hand. Above them the device has jumped, and no work is
// counted.
constexpr double kMaxHandSpeed_m_s = 40, kMaxHandSpin_rad_s = 100;

// Clamped as the surfaces are: a body that reports a higher speed gives no credit for it.
Eigen::Vector3d clamp_speed(const Eigen::Vector3d& velocity, double max_m_s) {
  const double speed = velocity.norm();
  return speed > max_m_s ? Eigen::Vector3d(velocity * (max_m_s / speed)) : velocity;
}

bool finite(const touch_applied_t& a) { return to_eigen(a.impulse_N_s).allFinite() && std::isfinite(a.energy_J); }
bool finite(const touch_plane_t& p) {
  return to_eigen(p.velocity_m_s).allFinite() && to_eigen(p.normal).allFinite() &&
         std::isfinite(p.effective_mass_kg) && p.effective_mass_kg > 0;
}

}  // namespace

Passivity::EnergyLedger* Passivity::find(std::int64_t contact_id) {
  for (EnergyLedger& b : ledgers_)
    if (b.contact_id == contact_id) return &b;
  return nullptr;
}

Passivity::EnergyLedger& Passivity::add(std::int64_t contact_id) {
  if (ledgers_.size() >= ContactImpulses::kMaxContacts)
    ledgers_.erase(
        std::max_element(ledgers_.begin(), ledgers_.end(),
                         [](const EnergyLedger& x, const EnergyLedger& y) { return x.idle_s < y.idle_s; }));
  EnergyLedger& b = ledgers_.emplace_back();
  b.contact_id = contact_id;
  return b;
}

void Passivity::on_message(const TouchModelView& fresh) {
  fresh.for_each_applied([&](const touch_applied_t& a) {
    if (finite(a)) on_message(a, fresh);
  });
}

void Passivity::on_message(const touch_applied_t& a, const TouchModelView& fresh) {
  EnergyLedger* b = find(a.contact_id);
  if (!b) b = &add(a.contact_id);
  const Eigen::Vector3d impulse_N_s = to_eigen(a.impulse_N_s);
  if (!b->reported) {
    b->reported = true;
    // More than this process can have given: the contact began before this process.
    if (impulse_N_s.norm() > 1.5 * b->pending.total_impulse_N_s().norm()) {
      b->baseline_J = a.energy_J;
      b->pending.reset(impulse_N_s);
    }
  }
  b->energy_J = a.energy_J;
  // When a contact is listed twice, the last entry counts, as for the surfaces.
  for (std::size_t i = fresh.plane_count(); i-- > 0;) {
    const touch_plane_t& p = fresh.plane(i);
    if (p.contact_id != a.contact_id || !finite(p)) continue;
    b->pending.on_report({fresh.header().sim_time_ns, p.effective_mass_kg, to_eigen(p.normal),
                          clamp_speed(to_eigen(p.velocity_m_s), limits_.speed_m_s), impulse_N_s},
                         limits_.force_N);
    return;
  }
  b->pending.on_report(impulse_N_s);
}

void Passivity::record(std::span<const ContactForce> forces, std::span<const Surface> surfaces,
                       const Eigen::Vector3d* about_m) {
  for (EnergyLedger& b : ledgers_) {
    b.force_N.setZero();
    b.torque_N_m.setZero();
  }
  for (std::size_t i = 0; i < forces.size() && i < surfaces.size(); ++i) {
    const ContactForce& f = forces[i];
    if (!surfaces[i].movable() || f.force_N.isZero(0) || !f.force_N.allFinite()) continue;
    EnergyLedger* b = find(f.contact_id);
    if (!b) b = &add(f.contact_id);
    b->force_N -= f.force_N;
    if (about_m) b->torque_N_m -= (f.point - *about_m).cross(f.force_N);
    b->idle_s = 0;
  }
}

void Passivity::begin_episode() {
  hand_J_ = closed_J_ = discarded_J_ = credit_J_ = 0;
  for (EnergyLedger& b : ledgers_) {
    b.baseline_J = b.energy_J;
    b.pending.reset();
  }
}

// Removes entries of facets that were touched long ago; the energy of their bodies stays counted.
void Passivity::remove_idle() {
  while (ledgers_.size() > kMaxLedgers) {
    const auto oldest =
        std::max_element(ledgers_.begin(), ledgers_.end(),
                         [](const EnergyLedger& x, const EnergyLedger& y) { return x.idle_s < y.idle_s; });
    if (oldest->idle_s <= kEpisodeGap_s) return;
    closed_J_ += oldest->energy_J - oldest->baseline_J;
    ledgers_.erase(oldest);
  }
}

void Passivity::observe(const StoredEnergy& coupling, const Eigen::Vector3d& moved_m,
                        const Eigen::Vector3d& turned_rad, double age_s, double dt) {
  const bool moved = moved_m.allFinite() && moved_m.norm() <= kMaxHandSpeed_m_s * dt;
  const bool turned = turned_rad.allFinite() && turned_rad.norm() <= kMaxHandSpin_rad_s * dt;
  const double window_s = std::max(0.0, age_s) + kRoundTrip_s;
  double bodies_J = 0, generated_W = 0;
  for (EnergyLedger& b : ledgers_) {
    b.pending.add_push(b.force_N, dt);
    if (moved) hand_J_ -= b.force_N.dot(moved_m);
    if (turned) hand_J_ -= b.torque_N_m.dot(turned_rad);
    b.idle_s += dt;
    bodies_J += b.energy_J - b.baseline_J;
    if (b.idle_s <= window_s) bodies_J += b.pending.energy_J(window_s, limits_.force_N);
    generated_W += b.force_N.dot(b.pending.velocity());
    if (moved && dt > 0) generated_W -= b.force_N.dot(moved_m) / dt;
    if (turned && dt > 0) generated_W -= b.torque_N_m.dot(turned_rad) / dt;
  }
  const double stored_J = coupling.energy_J;

  no_contact_s_ = coupling.pressed ? 0 : no_contact_s_ + dt;
  if (no_contact_s_ > kEpisodeGap_s) begin_episode(), bodies_J = 0;
  credit_J_ = -hand_J_ - closed_J_ - bodies_J - discarded_J_;
  if (credit_J_ < stored_J) discarded_J_ -= kRefill_W * dt;
  const double excess_J = std::max(0.0, credit_J_ - stored_J - kMaxCredit_J);
  discarded_J_ += excess_J;
  credit_J_ -= excess_J;
  const double allowed_J = std::max(0.0, credit_J_ + limits_.allowance_J);
  double wanted = 1;
  if (stored_J > allowed_J) {
    // Energy generated while the factor moves to `wanted`: half of the energy at the current force.
    const double falling_J = 0.5 / kFall_1_s * std::max(0.0, generated_W);
    wanted = stored_J > falling_J ? std::max(0.0, allowed_J - factor_ * falling_J) / (stored_J - falling_J) : 0.0;
  }
  factor_ = std::clamp(wanted, std::max(0.0, factor_ - kFall_1_s * dt), std::min(1.0, factor_ + kRise_1_s * dt));
  remove_idle();
}

}  // namespace tactus::haptic
