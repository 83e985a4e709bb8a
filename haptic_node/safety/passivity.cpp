#include "haptic_node/safety/passivity.h"

#include <cmath>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Number of entries kept without force. Design: several times the number in a touch model.
constexpr std::size_t kMaxLedgers = 32;
// Faster than any hand, as in hand_limits.h, with room for rotation (design): above them the device has jumped, and no
// work is counted.
constexpr double kMaxPushSpeed_m_s = 40, kMaxPushSpin_rad_s = 100;

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
  Wrench bodies;
  for (std::size_t i = 0; i < forces.size() && i < surfaces.size(); ++i) {
    const ContactForce& f = forces[i];
    if (!surfaces[i].movable() || f.force_N.isZero(0) || !f.force_N.allFinite()) continue;
    bodies.force_N += f.force_N;
    if (about_m) bodies.torque_N_m += (f.point - *about_m).cross(f.force_N);
    EnergyLedger* b = find(f.contact_id);
    if (!b) b = &add(f.contact_id);
    b->force_N -= f.force_N;
    if (about_m) b->torque_N_m -= (f.point - *about_m).cross(f.force_N);
    b->idle_s = 0;
  }
  from_bodies_.record(time_s_, bodies);
}

void Passivity::begin_body_episode() {
  bodies_.begin_episode();
  closed_J_ = 0;
  given_bodies_J_.clear();
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
    if (oldest->idle_s <= EnergyAccount::kEpisodeGap_s) return;
    closed_J_ += oldest->energy_J - oldest->baseline_J;
    ledgers_.erase(oldest);
  }
}

// Power that forces on the hand give to it at its newest speed, W.
double Passivity::generated_W(const Wrench& on_hand) const {
  if (!(motion_s_ > 0)) return 0;
  return (on_hand.force_N.dot(moved_m_) + on_hand.torque_N_m.dot(turned_rad_)) / motion_s_;
}

// Adds the motion to the accounts of the bodies. Returns the power that the current forces generate.
double Passivity::observe_bodies(const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad, double window_s,
                                 double dt, const DeviceLoop& loop) {
  double bodies_J = 0, power_W = 0;
  for (EnergyLedger& b : ledgers_) {
    b.pending.add_push(b.force_N, dt);
    // The sum of these is acting_in_tick; without a sum the result does not depend on the order of the contacts.
    if (loop.immediate())
      bodies_.give_hand(-b.force_N.dot(moved_m) - b.torque_N_m.dot(turned_rad));
    b.idle_s += dt;
    bodies_J += b.energy_J - b.baseline_J;
    if (b.idle_s <= window_s) bodies_J += b.pending.energy_J(window_s, limits_.force_N);
    power_W += b.force_N.dot(b.pending.velocity()) + generated_W({-b.force_N, -b.torque_N_m});
  }
  if (!loop.immediate()) {
    const Wrench acted = acting_in_tick(from_bodies_, time_s_, dt, loop);
    bodies_.give_hand(acted.force_N.dot(moved_m) + acted.torque_N_m.dot(turned_rad));
  }
  given_bodies_J_.record(time_s_, closed_J_ + bodies_J);
  return power_W;
}

void Passivity::observe(const StoredEnergy& bodies, const Eigen::Vector3d& moved_m,
                        const Eigen::Vector3d& turned_rad, double age_s, double dt, const DeviceLoop& loop) {
  time_s_ += dt;
  const double span_s = loop.immediate() ? dt : loop.span_s;
  const bool moved = moved_m.allFinite() && moved_m.norm() <= kMaxPushSpeed_m_s * span_s;
  const bool turned = turned_rad.allFinite() && turned_rad.norm() <= kMaxPushSpin_rad_s * span_s;
  const Eigen::Vector3d by_m = moved ? moved_m : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const Eigen::Vector3d by_rad = turned ? turned_rad : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (span_s > 0) moved_m_ = by_m, turned_rad_ = by_rad, motion_s_ = span_s;

  const double power_W = observe_bodies(by_m, by_rad, std::max(0.0, age_s) + limits_.round_trip_s, dt, loop);
  if (bodies_.apart(bodies.pressed, dt)) begin_body_episode();
  const double given_J = given_bodies_J_.empty() ? 0 : given_bodies_J_.at(time_s_ - loop.age_s);
  bodies_.settle(bodies.energy_J, given_J, power_W, limits_.allowance_J, dt);
  remove_idle();
}

}  // namespace tactus::haptic
