#include "haptic_node/safety/passivity.h"

#include <cmath>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Longer than any delay of a touch model before it counts as lost, so that the last reports have arrived.
constexpr double kApart_s = 0.2;
// From a tick to the simulation step that applies its force and back, in addition to the age of the touch model: a
// step and a tick.
constexpr double kWay_s = 0.002;
// Number of entries kept without force. Design: several times the number in a touch model.
constexpr std::size_t kMaxBooks = 32;
// Dissipated energy counts as credit up to this value, so that old friction does not pay for a new oscillation.
constexpr double kMaxCredit_J = 0.01;
// Refill rate of the allowance: after a violation, touch recovers within seconds.
constexpr double kRefill_W = 0.0002;
// The factor falls to zero within 5 ms at 1 kHz, which keeps a force of 8 N below the slew limit. It recovers
// within a second, slower than any oscillation of hand or body, so that it drives no cycle itself.
constexpr double kFall_1_s = 200, kRise_1_s = 1;
// As in safety.cpp: faster than any hand. The device jumped, and no work is counted.
constexpr double kFastest_m_s = 40, kFastest_rad_s = 100;

// Clamped as the surfaces are: a body that reports a higher speed gives no credit for it.
Eigen::Vector3d slow_enough(const Eigen::Vector3d& velocity, double most_m_s) {
  const double speed = velocity.norm();
  return speed > most_m_s ? Eigen::Vector3d(velocity * (most_m_s / speed)) : velocity;
}

bool finite(const touch_applied_t& a) { return to_eigen(a.impulse_N_s).allFinite() && std::isfinite(a.energy_J); }
bool finite(const touch_plane_t& p) {
  return to_eigen(p.velocity_m_s).allFinite() && to_eigen(p.normal).allFinite() &&
         std::isfinite(p.effective_mass_kg) && p.effective_mass_kg > 0;
}

}  // namespace

Passivity::Book* Passivity::find(std::int64_t contact_id) {
  for (Book& b : books_)
    if (b.contact_id == contact_id) return &b;
  return nullptr;
}

Passivity::Book& Passivity::add(std::int64_t contact_id) {
  if (books_.size() >= ContactImpulses::kMaxContacts)
    books_.erase(std::max_element(books_.begin(), books_.end(),
                                  [](const Book& x, const Book& y) { return x.idle_s < y.idle_s; }));
  Book& b = books_.emplace_back();
  b.contact_id = contact_id;
  return b;
}

void Passivity::hear(const TouchModelView& fresh) {
  fresh.each_book([&](const touch_applied_t& a) {
    if (finite(a)) hear(a, fresh);
  });
}

void Passivity::hear(const touch_applied_t& a, const TouchModelView& fresh) {
  Book* b = find(a.contact_id);
  if (!b) b = &add(a.contact_id);
  const Eigen::Vector3d impulse_N_s = to_eigen(a.impulse_N_s);
  if (!b->told) {
    b->told = true;
    // More than can have been given since it was first felt here: the simulation knows it from before.
    if (impulse_N_s.norm() > 1.5 * b->unseen.given_N_s().norm()) {
      b->before_J = a.energy_J;
      b->unseen.settle(impulse_N_s);
    }
  }
  b->energy_J = a.energy_J;
  // Told twice, the last counts, as for the surfaces.
  for (std::size_t i = fresh.plane_count(); i-- > 0;) {
    const touch_plane_t& p = fresh.plane(i);
    if (p.contact_id != a.contact_id || !finite(p)) continue;
    b->unseen.tell({fresh.header().sim_time_ns, p.effective_mass_kg, to_eigen(p.normal),
                    slow_enough(to_eigen(p.velocity_m_s), limits_.speed_m_s), impulse_N_s},
                   limits_.force_N);
    return;
  }
  b->unseen.tell(impulse_N_s);
}

void Passivity::note(std::span<const FeltForce> forces, std::span<const Surface> surfaces,
                     const Eigen::Vector3d* about_m) {
  for (Book& b : books_) {
    b.force_N.setZero();
    b.torque_N_m.setZero();
  }
  for (std::size_t i = 0; i < forces.size() && i < surfaces.size(); ++i) {
    const FeltForce& f = forces[i];
    if (!surfaces[i].moves() || f.force_N.isZero(0) || !f.force_N.allFinite()) continue;
    Book* b = find(f.contact_id);
    if (!b) b = &add(f.contact_id);
    b->force_N -= f.force_N;
    if (about_m) b->torque_N_m -= (f.point - *about_m).cross(f.force_N);
    b->idle_s = 0;
  }
}

void Passivity::begin_episode() {
  hand_J_ = settled_J_ = wasted_J_ = credit_J_ = 0;
  for (Book& b : books_) {
    b.before_J = b.energy_J;
    b.unseen.settle();
  }
}

// Removes entries of facets that were touched long ago; the energy of their bodies stays counted.
void Passivity::forget_the_idle() {
  while (books_.size() > kMaxBooks) {
    const auto oldest = std::max_element(books_.begin(), books_.end(),
                                         [](const Book& x, const Book& y) { return x.idle_s < y.idle_s; });
    if (oldest->idle_s <= kApart_s) return;
    settled_J_ += oldest->energy_J - oldest->before_J;
    books_.erase(oldest);
  }
}

void Passivity::observe(const Stored& coupling, const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad,
                        double age_s, double dt) {
  const bool moved = moved_m.allFinite() && moved_m.norm() <= kFastest_m_s * dt;
  const bool turned = turned_rad.allFinite() && turned_rad.norm() <= kFastest_rad_s * dt;
  const double window_s = std::max(0.0, age_s) + kWay_s;
  double bodies_J = 0, generating_W = 0;
  for (Book& b : books_) {
    b.unseen.give(b.force_N, dt);
    if (moved) hand_J_ -= b.force_N.dot(moved_m);
    if (turned) hand_J_ -= b.torque_N_m.dot(turned_rad);
    b.idle_s += dt;
    bodies_J += b.energy_J - b.before_J;
    if (b.idle_s <= window_s) bodies_J += b.unseen.energy_J(window_s, limits_.force_N);
    generating_W += b.force_N.dot(b.unseen.velocity());
    if (moved && dt > 0) generating_W -= b.force_N.dot(moved_m) / dt;
    if (turned && dt > 0) generating_W -= b.torque_N_m.dot(turned_rad) / dt;
  }
  const double stored_J = coupling.energy_J;

  apart_s_ = coupling.pressed ? 0 : apart_s_ + dt;
  if (apart_s_ > kApart_s) begin_episode(), bodies_J = 0;
  credit_J_ = -hand_J_ - settled_J_ - bodies_J - wasted_J_;
  if (credit_J_ < stored_J) wasted_J_ -= kRefill_W * dt;
  const double beyond_J = std::max(0.0, credit_J_ - stored_J - kMaxCredit_J);
  wasted_J_ += beyond_J;
  credit_J_ -= beyond_J;
  const double allowed_J = std::max(0.0, credit_J_ + limits_.allowance_J);
  double wanted = 1;
  if (stored_J > allowed_J) {
    // Energy generated while the factor moves to `wanted`: half of the energy at the present force.
    const double falling_J = 0.5 / kFall_1_s * std::max(0.0, generating_W);
    wanted = stored_J > falling_J ? std::max(0.0, allowed_J - factor_ * falling_J) / (stored_J - falling_J) : 0.0;
  }
  factor_ = std::clamp(wanted, std::max(0.0, factor_ - kFall_1_s * dt), std::min(1.0, factor_ + kRise_1_s * dt));
  forget_the_idle();
}

}  // namespace tactus::haptic
