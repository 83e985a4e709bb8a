// Safety limits of the device: on the force, its rise, the energy given to the hand and the workspace, for any input;
// and the fade when the touch model is lost. The hand, its force and the energy that it received persist across
// scenes, so there is one Safety per process.
//
// The force that leaves is the wanted one times a factor of 0 to 1. It rises slowly and falls at once: a force that
// stayed behind the wanted one would push a hand that withdraws, and give it energy.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "haptic_node/devices/device.h"
#include "haptic_node/settings.gen.h"
#include "sync/time/time.h"

namespace tactus::haptic {

struct SafetyLimits {
  double force_N = 8;
  double slew_N_s = 2000;
  double energy_J = 0.49;
  double power_W = 1;
  double torque_N_m = 0.3;
  double torque_slew_N_m_s = 75;
  double workspace_m = 2;
  double period_s = 0.001;  // of the tick
};
SafetyLimits safety_limits(const Settings& settings);

// A passivity observer (Hannaford and Ryu 2002) with an allowance: a tank that energy to the hand drains and
// energy from the hand fills, plus a small constant power. The force goes to zero as the tank empties.
class Safety {
 public:
  explicit Safety(const SafetyLimits& limits) : limits_(limits), tank_J_(limits.energy_J) {}

  // Applies changed limits. The spent energy stays counted.
  void set_limits(const SafetyLimits& limits) { limits_ = limits; }
  // Call when another scene begins, whose surfaces do not give the current force. The current force goes to zero within
  // kRelease_s, beside the force of the new scene.
  void release();
  static constexpr double kRelease_s = 0.02;

  // Begins a tick. A force that was not written within the watchdog time of the device has been dropped. The same
  // after a step of the clock: how long the force acted is then unknown.
  void begin_tick(sync::HostTime now);

  // Sets the position of the device; call before limit(). The workspace is a ball about the first position. The
  // force goes to zero over its outermost tenth and is zero outside. A position that is not finite is outside.
  void set_position(const Eigen::Vector3d& device_m);

  // The wrench that acted during the motion of the next limit(), and the duration of that motion, > 0. Call it when the
  // device has its own period or delay; without it, the motion is that of dt, under the force returned last.
  void set_acting(const Wrench& acting, double span_s) { acting_ = Acting{acting, span_s}; }

  // One tick: returns the force to command now, N: the wanted one times a factor of 0 to 1, plus released(). Its
  // magnitude is at most the part of the last force along it plus the slew limit times dt; a late tick counts as
  // two ticks. moved_m: motion of the device since the last call, under the force returned then. A wanted force that is
  // not finite counts as zero. Realtime-safe: yes.
  Eigen::Vector3d limit(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& moved_m, double dt);

  // The same for force and torque together: when one reaches its limit, both are reduced, so that the felt
  // contact point does not move. turned_rad: rotation of the device.
  Wrench limit(const Wrench& wanted, const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad, double dt);

  // The part of the wrench returned last that is left over from the previous scene. No surface of this scene gave it.
  const Wrench& released() const { return released_; }
  // Energy given to the hand since the start, J.
  double energy_J() const { return energy_J_; }

 private:
  struct Acting {
    Wrench wrench;
    double span_s;
  };
  // As set, otherwise the whole wrench returned last, for dt.
  Acting acting(double dt) const;
  double share_now() const;

  SafetyLimits limits_;
  double tank_J_;
  double energy_J_ = 0;
  std::optional<Acting> acting_;  // for the next limit()
  Wrench last_;      // as returned, without released_
  Wrench released_;  // falls to zero within release_s_
  double release_s_ = 0;
  double torque_work_J_ = 0;  // of the torque, since the last tick
  sync::HostTime last_tick_{};
  std::optional<Eigen::Vector3d> centre_m_;
  double workspace_factor_ = 1;  // factor of the workspace
};

// Factor on the force: 1 while touch models arrive. It goes to 0 within `fade` once the newest is older than
// stale_after, and back to 1 at the same rate. It never changes faster.
class Fade {
 public:
  Fade(double stale_after_s, double fade_s) : stale_after_s_(stale_after_s), fade_s_(fade_s) {}
  // newest: arrival of the newest touch model, as measured; empty: none yet. An arrival that lies ahead of the clock by
  // more than stale_after is older than a step of the clock, and counts as lost.
  double step(sync::HostTime now, std::optional<sync::HostTime> newest, double dt);
  // The world has begun again: the factor goes to 0 before it returns. The models that arrive until then belong to
  // another world than the surfaces under the hand.
  void restart() { restarting_ = value_ > 0; }
  bool restarting() const { return restarting_; }
  double value() const { return value_; }
  bool lost() const { return lost_; }

 private:
  double stale_after_s_, fade_s_;
  double value_ = 0;
  bool lost_ = true, restarting_ = false;
};

}  // namespace tactus::haptic
