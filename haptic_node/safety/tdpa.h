// Time-domain passivity control of a delayed force, as one end of a kinaesthetic codec has it: the hand receives at most the
// energy that the other end has released, as far as the packets that have arrived report it (Hannaford and Ryu 2002, "Time-domain
// passivity control of haptic interfaces"; energy in each packet: Ryu, Artigas and Preusche 2010, "A passive bilateral control
// scheme for a teleoperator with time-varying communication delay").
//
//   excess = energy given to the hand + energy of the coming tick - received energy
//   damper = excess / (v^2 dt), for excess > 0; the force becomes F - damper v
//
// The damper only takes away force that pushes the hand further: it never reverses a force, and an excess that it cannot take in
// one tick remains counted. When a deadband suppresses a packet, the last sent energy counts, which is at most the true one. Pure.
#pragma once

#include "haptic_node/safety/motion_work.h"

namespace tactus::haptic {

class TimeDomainPassivity {
 public:
  // Below this speed, m/s, the damper does not act, because noise would decide its sign.
  static constexpr double kMinSpeed_m_s = 0.001;

  void reset() { *this = TimeDomainPassivity(); }
  // Begins to control. promised_J: sum of the energy that packets from before may report, which gives no credit.
  void begin(double promised_J) {
    reset();
    out_J_ = received_J_ = promised_J;
  }
  // Energy that a wrench gives to the hand during a motion, J, >= 0: force and torque apart, so that energy from a turning
  // hand does not pay for the force of the same tick.
  static double given_J(const Wrench& wrench, const DeviceMotion& during, double held_s);

  // Work that the displayed force has done on the hand since the last call, J; below zero: the hand gave it.
  void observe(double work_J);
  // A new episode of contact: unused energy does not pay for it.
  void forget_credit();
  // The wrench to display. wanted: before the controller; during: motion that the hand is expected to make while the wrench acts,
  // for held_s; received_J: sum of the energy that the other end has released, from the newest packet. Realtime-safe: yes.
  Wrench control(const Wrench& wanted, const DeviceMotion& during, double held_s, double received_J);

  // Sums of the energy that the hand gave and got, J, >= 0.
  double in_J() const { return in_J_; }
  double out_J() const { return out_J_; }
  // Energy that the packets have promised so far, J.
  double received_J() const { return received_J_; }
  // Damper of the last call of control(), N s/m; of a rotation that is braked too, the same share of its torque is taken.
  double damping_N_s_m() const { return damping_N_s_m_; }

 private:
  double in_J_ = 0, out_J_ = 0, received_J_ = 0, damping_N_s_m_ = 0;
};

}  // namespace tactus::haptic
