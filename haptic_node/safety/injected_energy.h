// Energy that a late or coarse display of the force gives to the hand, and the brake that bounds it: time-domain passivity of
// the display as one port (Hannaford and Ryu 2002).
//
// The bodies receive the opposite of the computed force at once, so the accounts of walls and bodies (wall_energy.h,
// passivity.h) hold for the computed force. This account covers the difference to the displayed force. In an episode of contact
//
//   injected = work of the displayed force on the hand - the most work that the computed force had done on it, or 0
//
// A spring that is displayed late by tau acts as a damper of -K sin(omega tau) / omega: it pushes the hand longer than the hand
// pushed it. The brake keeps
//
//   injected <= allowance + energy that the damping of the device has dissipated
//
// by a factor on the force that is about to be displayed, for a motion that continues as in the last tick and that the force
// accelerates. A force that resists the motion is never braked. A display that has shown exactly the computed force since the
// episode began is not braked either. Pure.
#pragma once

#include "haptic_node/safety/motion_work.h"

namespace tactus::haptic {

struct InjectedLimits {
  double allowance_J = 0.0005;
  // Mass, inertia and damping of the lightest hand that the brake assumes, as of WallLimits.
  double device_mass_kg = 0.1, device_inertia_kg_m2 = 0.0003;
  double device_damping_N_s_m = 0, device_turn_damping_N_m_s_rad = 0;
  // Largest stiffness that the coupling may have. Its share of the damping of the device, K (T/2 + delay) / 0.8
  // (rendering/coupling.h), and its damper are no credit here.
  double stiffness_limit_N_m = 2000;
};

class InjectedEnergy {
 public:
  explicit InjectedEnergy(const InjectedLimits& limits) : limits_(limits) {}
  void change(const InjectedLimits& limits) { limits_ = limits; }
  // Touch restarts, and no force from before acts.
  void reset();

  // One tick. displayed, computed: wrenches that acted, or would have acted, on the hand during `motion`, which took span_s.
  // stored_J: energy in all springs of the coupling at full stiffness. dt: duration of the tick. Realtime-safe: yes.
  void observe(const Wrench& displayed, const Wrench& computed, const DeviceMotion& motion, double span_s, double stored_J,
               double dt);
  // Factor on the wrench that is about to be displayed, 0 .. 1. computed: the computed one of the same tick. same: nothing has
  // changed it. held_s: time until the device applies the next one. Realtime-safe: yes.
  double brake(const Wrench& displayed, const Wrench& computed, bool same, double held_s);

  // Injected energy in this episode, J, 0 .. kMaxReported_J.
  double injected_J() const;
  // Energy that the damping of the device has dissipated in this episode, as far as it counts, J.
  double dissipated_J() const { return dissipated_J_; }

 private:
  static constexpr double kMaxReported_J = 1e6;  // the range of the message

  double free_damping_N_s_m(double held_s, double delay_s) const;

  InjectedLimits limits_;
  // Work on the hand in this episode: of the displayed and of the computed force, and the most of the latter.
  double displayed_J_ = 0, computed_J_ = 0, max_computed_J_ = 0;
  double dissipated_J_ = 0, credit_J_ = 0, max_stored_J_ = 0;
  DeviceMotion motion_;   // newest motion of the device, and its duration
  double motion_s_ = 0;
  double apart_s_ = 0;  // time without either force
  bool same_ = true;    // the displayed force has been the computed one
};

}  // namespace tactus::haptic
