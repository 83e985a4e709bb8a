#include "haptic_node/devices/virtual_hand.h"

#include <cmath>

#include "haptic_node/contact/rotation_math.h"

namespace tactus::haptic {
namespace {

// exp(A t) of e'' = -w2 e - 2 a e' is exp(-a t) (c I + s (A + a I)): c and s below.
struct Propagator {
  double decay, c, s;
};

Propagator propagator(double a, double w2, double t) {
  const double q = a * a - w2;
  const double decay = std::exp(-a * t);
  if (std::abs(q) * t * t < 1e-12) return {decay, 1, t};
  const double r = std::sqrt(std::abs(q));
  if (q > 0) return {decay, std::cosh(r * t), std::sinh(r * t) / r};
  return {decay, std::cos(r * t), std::sin(r * t) / r};
}

struct Oscillator {
  double mass, damping, stiffness;
};

// Exact for a constant load and a target that moves uniformly from `from` to `to`: stable for any step size.
void advance(const Oscillator& o, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             const Eigen::Vector3d& load, double dt, Eigen::Vector3d& place, Eigen::Vector3d& rate) {
  const double a = o.damping / (2 * o.mass), w2 = o.stiffness / o.mass;
  const Eigen::Vector3d drift = (to - from) / dt;
  const Eigen::Vector3d rest = load / o.stiffness;  // offset from the target at equilibrium
  const Eigen::Vector3d e = place - from - rest, de = rate - drift;
  const auto [decay, c, s] = propagator(a, w2, dt);
  place = to + rest + decay * ((c + s * a) * e + s * de);
  rate = drift + decay * (-s * w2 * e + (c - s * a) * de);
}

}  // namespace

VirtualHand::VirtualHand(MonotoneCubic path, bool loop, const HandImpedance& hand, const Eigen::Quaterniond& rest)
    : path_(std::move(path)), loop_(loop), hand_(hand), rest_(rest) {}

MonotoneCubic::At VirtualHand::target(sync::HostTime now) const {
  double t = begin_ && now > *begin_ ? sync::to_seconds(now - *begin_) : 0;
  const double period = path_.end_s() - path_.begin_s();
  if (loop_ && period > 0 && t > path_.end_s()) t = path_.begin_s() + std::fmod(t - path_.begin_s(), period);
  return path_.at(t);
}

void VirtualHand::advance(const MonotoneCubic::At& to, double dt) {
  if (dt <= 0) return;
  haptic::advance({hand_.mass_kg, hand_.damping_N_s_m, hand_.stiffness_N_m}, target_.position, to.position,
                  felt_.force_N, dt, position_, velocity_);
  haptic::advance({hand_.inertia_kg_m2, hand_.turn_damping_N_m_s, hand_.turn_stiffness_N_m},
                  Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), felt_.torque_N_m, dt, rotation_, spin_);
  target_ = to;
}

DeviceState VirtualHand::read(sync::HostTime now) {
  if (!read_) {
    read_ = true;
    last_ = now;
    target_ = target(now);
    position_ = target_.position;
  }
  const sync::HostTime released = last_ + kWatchdog;
  if (now > released) {
    advance(target(released), sync::to_seconds(kWatchdog));
    felt_ = {};
    last_ = released;
  }
  if (now > last_) {
    advance(target(now), sync::to_seconds(now - last_));
    last_ = now;
  }
  DeviceState state;
  state.position = position_;
  state.velocity = velocity_;
  state.orientation = rotated_by(rotation_, rest_);
  state.spin = spin_;
  return state;
}

}  // namespace tactus::haptic
