// Safety limits of the device: on the force, its rate of change, the energy given to the hand and the workspace,
// for any input; and the fade when the touch model is lost. The hand, its force and the energy that it received
// persist across scenes, so there is one Safety per process.
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

  // Applies the limits of another scene. The spent energy stays counted and the force continues from its current
  // value.
  void set_limits(const SafetyLimits& limits) { limits_ = limits; }

  // Begins a tick. A force that was not written within the watchdog time of the device has been dropped.
  void begin_tick(sync::HostTime now);

  // Sets the position of the device; call before limit(). The workspace is a ball about the first position. The
  // force goes to zero over its outermost tenth and is zero outside. A position that is not finite is outside.
  void set_position(const Eigen::Vector3d& device_m);

  // The wrench that acted during the motion of the next limit(), and the duration of that motion, > 0. Call it when the
  // device has its own period or delay; without it, the motion is that of dt, under the force returned last.
  void set_acting(const Wrench& acting, double span_s) { acting_ = Acting{acting, span_s}; }

  // One tick: returns the force to command now, N. moved_m: motion of the device since the last call, under the
  // force returned then. A wanted force that is not finite counts as zero. Realtime-safe: yes.
  Eigen::Vector3d limit(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& moved_m, double dt);

  // The same for force and torque together: when one reaches its limit, both are reduced, so that the felt
  // contact point does not move. turned_rad: rotation of the device.
  Wrench limit(const Wrench& wanted, const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad, double dt);

  // Energy given to the hand since the start, J.
  double energy_J() const { return energy_J_; }
  // Energy that the hand may receive now, J.

 private:
  SafetyLimits limits_;
  double tank_J_;
  double energy_J_ = 0;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), last_torque_ = Eigen::Vector3d::Zero();
  struct Acting {
    Wrench wrench;
    double span_s;
  };
  std::optional<Acting> acting_;  // for the next limit()
  double torque_work_J_ = 0;  // of the torque, since the last tick
  sync::HostTime last_tick_{};
  std::optional<Eigen::Vector3d> centre_m_;
  double workspace_factor_ = 1;  // factor of the workspace
};

// Factor on the force: 1 while touch models arrive. It goes to 0 within `fade` once the newest is older than
// stale_after, and back to 1 at the same rate.
class Fade {
 public:
  Fade(double stale_after_s, double fade_s) : stale_after_s_(stale_after_s), fade_s_(fade_s) {}
  // newest: arrival of the newest touch model, as measured; empty: none yet.
  double step(sync::HostTime now, std::optional<sync::HostTime> newest, double dt);
  double value() const { return value_; }
  bool lost() const { return lost_; }

 private:
  double stale_after_s_, fade_s_;
  double value_ = 0;
  bool lost_ = true;
};

}  // namespace tactus::haptic
