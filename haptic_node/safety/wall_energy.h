// Energy account of fixed surfaces. A wall returns at most the energy that the hand gave it (time-domain passivity:
// Hannaford and Ryu 2002).
//
//   credit = energy from the hand to the walls in this episode of contact; below zero: generated
//
// The force of a wall may lag (slew limit), come in steps (force_step), or come too late (a plane that appears only
// when the hand is inside). In each case the springs of the coupling would hold more than the credit. Two measures
// limit the energy: a factor on the coupling, so that its springs hold at most the credit and the allowance; and a
// brake on the force to command, so that the next tick gives the hand at most the credit and the allowance beyond its
// default, with which a contact begins. Undisturbed walls hold less than the credit: both are then 1. A softened wall recovers while the hand
// presses, and when the hand was away.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "haptic_node/contact/contact_impulses.h"
#include "haptic_node/contact/surfaces.h"
#include "haptic_node/devices/device.h"

namespace tactus::haptic {

// Force of all fixed surfaces on the hand.
struct WallForce {
  Wrench wrench;      // on the hand
  double power_W = 0;  // of the motion of the surfaces themselves, as a conveyor has
};

struct WallLimits {
  double allowance_J = 0.0005;
  // Mass and moment of inertia that move with the handle: the lightest hand that the brake assumes.
  double device_mass_kg = 0.1, device_inertia_kg_m2 = 0.0003;
};

// Motion of the device within a tick.
struct DeviceMotion {
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero(), turned_rad = Eigen::Vector3d::Zero();
};

class WallEnergy {
 public:
  explicit WallEnergy(const WallLimits& limits) : limits_(limits) {}
  void change(const WallLimits& limits) { limits_ = limits; }

  // Forgets the episode.
  void reset();
  // One tick, after the depths are solved. springs_J: energy of the coupling to walls at full stiffness; pressed:
  // whether any is pressed. motion: since record(). held_s: time since then. begins: touch begins or returns,
  // and its surfaces appear; the energy of the springs is then credited, because the hand may already be inside.
  // Realtime-safe: yes.
  void observe(double springs_J, bool pressed, const DeviceMotion& motion, double held_s, bool begins);
  // Stores the force on the hand that acts from now on.
  void record(const WallForce& commanded) { commanded_ = commanded; }

  // Factor on the coupling to walls, 0 .. 1.
  double factor() const { return factor_; }
  // Factor on a force that is about to be commanded, 0 .. 1. last: motion in the last tick. Assumes that the
  // hand continues as in the last tick and that the force accelerates it. Realtime-safe: yes.
  double brake(const WallForce& next, const DeviceMotion& last, double dt) const;
  // Energy that the walls have given to the hand since the episode began, beyond what they received, J.
  double generated_J() const { return std::clamp(-credit_J_, 0.0, kMaxReported_J); }

 private:
  static constexpr double kMaxReported_J = 1e6;  // the range of the message

  WallLimits limits_;
  WallForce commanded_;
  double credit_J_ = 0, factor_ = 1;
  double apart_s_ = 0;  // time since a wall was pressed
};

// Adds up the forces of the fixed surfaces. arms: from the reference point of the torque to each contact; empty: no
// torque is rendered.
WallForce wall_force(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces,
                     std::span<const Eigen::Vector3d> arms);

}  // namespace tactus::haptic
