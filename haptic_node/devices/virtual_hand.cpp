#include "haptic_node/devices/virtual_hand.h"

#include <cmath>

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

}  // namespace

VirtualHand::VirtualHand(MonotoneCubic path, bool loop, const HandImpedance& hand)
    : path_(std::move(path)), loop_(loop), hand_(hand) {}

MonotoneCubic::At VirtualHand::target(sync::HostTime now) const {
  double t = begin_ && now > *begin_ ? sync::to_seconds(now - *begin_) : 0;
  const double period = path_.end_s() - path_.begin_s();
  if (loop_ && period > 0 && t > path_.end_s()) t = path_.begin_s() + std::fmod(t - path_.begin_s(), period);
  return path_.at(t);
}

// Exact for a constant force and a target that moves evenly from target_ to `to`: no step size makes it unstable.
void VirtualHand::advance(const MonotoneCubic::At& to, const Eigen::Vector3d& force_N, double dt) {
  if (dt <= 0) return;
  const double a = hand_.damping_N_s_m / (2 * hand_.mass_kg), w2 = hand_.stiffness_N_m / hand_.mass_kg;
  const Eigen::Vector3d drift = (to.position - target_.position) / dt;
  const Eigen::Vector3d rest = force_N / hand_.stiffness_N_m;  // offset from the target at which nothing moves
  const Eigen::Vector3d e = position_ - target_.position - rest, de = velocity_ - drift;
  const auto [decay, c, s] = propagator(a, w2, dt);
  position_ = to.position + rest + decay * ((c + s * a) * e + s * de);
  velocity_ = drift + decay * (-s * w2 * e + (c - s * a) * de);
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
    advance(target(released), force_, sync::to_seconds(kWatchdog));
    force_.setZero();
    last_ = released;
  }
  if (now > last_) {
    advance(target(now), force_, sync::to_seconds(now - last_));
    last_ = now;
  }
  DeviceState state;
  state.position = position_;
  state.velocity = velocity_;
  return state;
}

}  // namespace tactus::haptic
