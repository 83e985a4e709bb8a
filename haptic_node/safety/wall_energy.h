// Energy account of fixed surfaces. A wall returns at most the energy that the hand gave it (time-domain passivity:
// Hannaford and Ryu 2002).
//
//   credit = energy from the hand to the walls in this episode of contact; below zero: generated
//
// The force of a wall may lag (slew limit), come in steps (force_step), or come too late (a plane that appears only
// when the hand is inside). In each case the springs of the coupling would hold more than the credit. Two measures
// limit the energy: a factor on the coupling, so that its springs hold at most the credit and the allowance; and a
// brake on the force to command, so that the next tick gives the hand at most the credit and the allowance beyond its
// default, with which a contact begins. Undisturbed walls hold less than the credit: both are then 1. A softened wall
// recovers while the hand presses, and when the hand was away.
//
// The map of a relief tilts the force and moves the surface under a hand that moves along it. The energy of both is its own:
// a hand that presses harder downhill than uphill gains the difference. The account contains the force without its tilt,
// and adds the energy that a change of height puts into the springs. The limits of energy and power (safety.h) bound the
// rest.
//
// The motion of a device with its own period and delay is paired with the force that acted during it (acting_force.h).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "haptic_node/contact/contact_impulses.h"
#include "haptic_node/contact/reliefs.h"
#include "haptic_node/contact/surfaces.h"
#include "haptic_node/devices/device.h"
#include "haptic_node/safety/acting_force.h"
#include "haptic_node/safety/motion_work.h"

namespace tactus::haptic {

// Force of all fixed surfaces on the hand.
struct WallForce {
  Wrench wrench;       // on the hand
  Wrench tilt;         // its part that the maps of reliefs add
  double power_W = 0;  // of the motion of the surfaces themselves, as a conveyor has
  // The wrench without that part.
  Wrench plain() const { return plus_scaled(wrench, tilt, -1); }
};

struct WallLimits {
  double allowance_J = 0.0005;
  // Mass and moment of inertia that move with the handle: the lightest hand that the brake assumes; and the least
  // damping of the device.
  double device_mass_kg = 0.1, device_inertia_kg_m2 = 0.0003;
  double device_damping_N_s_m = 0, device_turn_damping_N_m_s_rad = 0;
};

inline WallForce plus_scaled(const WallForce& a, const WallForce& b, double scale) {
  return {plus_scaled(a.wrench, b.wrench, scale), plus_scaled(a.tilt, b.tilt, scale), a.power_W + scale * b.power_W};
}

class WallEnergy {
 public:
  explicit WallEnergy(const WallLimits& limits) : limits_(limits) {}
  void change(const WallLimits& limits) { limits_ = limits; }

  // The device has dropped the force, and touch restarts: clears the episode and the commands.
  void reset();
  // One tick, after the depths are solved. springs_J: energy of the coupling to walls at full stiffness; pressed:
  // whether any is pressed. motion: since the last call. held_s: time since then. appeared_J: the part
  // of springs_J that surfaces brought when they appeared above a hand that was already inside. It is credited; the part
  // that the hand pressed is not, because its force may still fade in. relief_J: energy that changes of height put into the
  // springs since the last call; below zero: took. Realtime-safe: yes.
  void observe(double springs_J, bool pressed, const DeviceMotion& motion, double held_s, double appeared_J,
               double relief_J = 0);
  // Stores the force on the hand that acts from now on.
  void record(const WallForce& commanded) { commands_.record(time_s_, commanded); }

  // Factor on the coupling to walls, 0 .. 1.
  double factor() const { return factor_; }
  // Energy that the springs may gain without softening the coupling, J; half of the allowance is left.
  double headroom_J() const { return headroom_J_; }
  // Factor on a force that is about to be commanded, 0 .. 1. last: motion in the last tick. Assumes that the
  // hand continues as in its last motion and that the force accelerates it, until the device applies the next one.
  // Realtime-safe: yes.
  double brake(const WallForce& next, const DeviceMotion& last, double dt) const;
  // Energy that the walls have given to the hand since the episode began, beyond the received energy, J.
  double generated_J() const { return std::clamp(-balance_J_, 0.0, kMaxReported_J); }

 private:
  static constexpr double kMaxReported_J = 1e6;  // the range of the message

  WallLimits limits_;
  History<WallForce> commands_;
  double time_s_ = 0;  // of the tick
  // Newest motion of a device with its own period, and its duration.
  DeviceMotion motion_;
  double motion_s_ = 0;
  double balance_J_ = 0, credit_J_ = 0;  // without and with the limit of the credit
  double factor_ = 1, headroom_J_ = 0;
  double apart_s_ = 0;  // time since a wall was pressed
};

// Adds up the forces of the fixed surfaces. arms: from the reference point of the torque to each contact; empty: no
// torque is rendered.
WallForce wall_force(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces,
                     std::span<const Eigen::Vector3d> arms);

}  // namespace tactus::haptic
