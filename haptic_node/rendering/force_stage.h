// The stage `force` of a profile: the hand gets the computed force late, coarse or not at all, while the bodies receive the
// opposite of the computed force at once. Pure.
//
//   wanted force ─┬─ limits, as if it were displayed ───────────────────────────▶ opposite force on the bodies
//                 └─ operators of the stage ─ TDPA, if asked for (tdpa.h) ─ brake (injected_energy.h) ─ limits ─▶ hand
//
// The limits of safety are the last stage of both. While the stage is active there are two sets of them, which begin equal: the
// bodies then receive exactly what they would receive without the stage, for the same motion of the hand.
#pragma once

#include <optional>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "haptic_node/safety/injected_energy.h"
#include "haptic_node/safety/acting_force.h"
#include "haptic_node/safety/safety.h"
#include "haptic_node/safety/tdpa.h"
#include "haptic_node/settings.gen.h"
#include "sync/degradation/stage_signal.h"

namespace tactus::haptic {

// The limits of the force of one receiver, and the history of the limited force.
struct ForceOutput {
  Safety& safety;
  ForceHistory& commands;
};

class ForceStage {
 public:
  explicit ForceStage(const Settings& settings);
  void change(const Settings& settings);

  // Begins a tick; operators: of the stage, valid until the next tick; null or empty: none. safety, commands: of the hand, from
  // which those of the bodies continue when the stage becomes active. Call it before Safety::begin_tick.
  void begin_tick(sync::HostTime now, sync::SimTime world, sync::OperatorChain* operators, sync::Decisions* decisions,
                  const Safety& safety, const ForceHistory& commands);
  void set_position(const Eigen::Vector3d& device_m) {
    if (reaction_) reaction_->set_position(device_m);
  }
  bool active() const { return reaction_.has_value(); }
  // While active: the limits of the force whose opposite the bodies receive.
  ForceOutput bodies() { return {*reaction_, reaction_commands_}; }
  // The device has dropped the force, and touch restarts.
  void restart();

  // While active, in each tick before new forces: accounts for the forces that acted during the motion. commands: to the hand.
  // stored_J: energy in the springs of the coupling. dt: duration of the tick. Realtime-safe: yes.
  void observe(double stored_J, const DeviceMotion& motion, const ForceHistory& commands, double dt);
  // While active: the wrench to display, before the limits of the hand. wanted: of this tick, before any limit, of which
  // transient_N is a part; reaction: after the limits of the bodies. share: factor of losses that `wanted` contains, which also
  // applies to a late sample. Realtime-safe: yes.
  Wrench display(const Wrench& wanted, const Wrench& reaction, const Eigen::Vector3d& transient_N, double share,
                 const DeviceMotion& motion, double dt);
  // Part of the wrench returned last that is due to hits, N.
  const Eigen::Vector3d& transient_N() const { return transient_N_; }
  // Energy that the stage has given to the hand in this episode of contact, J; 0 while it is not active.
  double injected_J() const { return active() ? injected_.injected_J() : 0; }
  // The controller of passivity="tdpa".
  const TimeDomainPassivity& tdpa() const { return tdpa_; }

  // Moves reports of presented events to the time at which the hand gets their force.
  void delay(std::vector<presentation_t>& reports) const;

 private:
  void observe_tdpa(const Wrench& displayed, const Wrench& computed, const DeviceMotion& motion, double span_s, double dt);
  DeviceMotion expected_motion(double held_s) const;
  void limit_to_share(sync::ForceSample& shown, double share) const;

  std::optional<Safety> reaction_;  // of the bodies; nothing: the stage is not active
  ForceHistory reaction_commands_;
  sync::StageSignal signal_;
  SafetyLimits limits_;
  InjectedEnergy injected_;
  // The two ends of the channel of passivity="tdpa".
  TimeDomainPassivity tdpa_;
  double released_J_ = 0;      // energy that the computed force has released, which the packets report
  bool controls_ = false;      // the profile asks for it
  bool same_ = true;           // in this episode, the displayed force has been the computed one
  double apart_s_ = 0;         // time without either force
  DeviceMotion motion_;        // newest motion of the device, and its duration
  double motion_s_ = 0;
  sync::OperatorChain* operators_ = nullptr;
  sync::Decisions* decisions_ = nullptr;
  sync::HostTime now_{};
  sync::SimTime world_{};
  Eigen::Vector3d transient_N_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::haptic
