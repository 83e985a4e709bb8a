// What keeps the person safe whatever arrives: the force is limited in size, in change per time and in the energy
// that it gives to the hand and in where it acts, and it fades when the touch model is lost. Scenes come and go;
// the hand, its force and what it has been given stay, so there is one Safety for the life of the process.
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
};
SafetyLimits safety_limits(const Settings& settings);

// A passivity observer (Hannaford and Ryu 2002) with an allowance: a tank that what the hand takes in drains and
// what it gives fills, besides a small power. As it empties the force goes to zero.
class Safety {
 public:
  explicit Safety(const SafetyLimits& limits) : limits_(limits), tank_J_(limits.energy_J) {}

  // Those of another scene. What the hand has been given stays given, and the force goes on from where it is.
  void set_limits(const SafetyLimits& limits) { limits_ = limits; }

  // A tick begins. A force that was not renewed within the watchdog of the device has been let go.
  void begin_tick(sync::HostTime now);

  // Where the device is, before limit. The workspace is a ball about the place where it was first; over the
  // outermost tenth of it the force goes to zero, outside there is none. A place that is not finite is outside.
  void at(const Eigen::Vector3d& device_m);

  // One tick: the force to command now, N. moved_m: how far the device moved since the last call, under the force
  // that was returned then. A wanted force that is not finite counts as none. Realtime-safe: yes.
  Eigen::Vector3d limit(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& moved_m, double dt);

  // The same of force and torque together: a limit of size that one reaches holds back both, so that what is felt
  // comes from where it did. turned_rad: how far the device turned.
  Wrench limit(const Wrench& wanted, const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad, double dt);

  // Energy given to the hand since the beginning, J.
  double energy_J() const { return energy_J_; }
  // What the hand may still be given at once, J.
  double tank_J() const { return tank_J_; }

 private:
  SafetyLimits limits_;
  double tank_J_;
  double energy_J_ = 0;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), last_torque_ = Eigen::Vector3d::Zero();
  double turn_work_J_ = 0;  // of the torque, since the last tick
  sync::HostTime renewed_{};
  std::optional<Eigen::Vector3d> centre_m_;
  double inside_ = 1;  // factor of the workspace
};

// Factor on the force: 1 while touch models arrive, to 0 within `fade` from the moment at which the newest is
// older than stale_after, and back as slowly.
class Fade {
 public:
  Fade(double stale_after_s, double fade_s) : stale_after_s_(stale_after_s), fade_s_(fade_s) {}
  // newest: when the newest touch model arrived, raw; nothing: none yet.
  double step(sync::HostTime now, std::optional<sync::HostTime> newest, double dt);
  double value() const { return value_; }
  bool lost() const { return lost_; }

 private:
  double stale_after_s_, fade_s_;
  double value_ = 0;
  bool lost_ = true;
};

}  // namespace tactus::haptic
