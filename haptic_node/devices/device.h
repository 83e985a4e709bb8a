// Interface of a haptic device: a source of pose and a sink of force. Pure: time is an argument, so the servo loop
// handles real and simulated devices in the same way.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {
struct OwnClock;
}

namespace tactus::haptic {

// Timing of the loop through a device, s. All zero: the device is read and commanded in the tick itself.
struct DeviceLoop {
  double period_s = 0;       // longest recent interval between two states
  double interval_s = 0;     // mean interval
  double age_s = 0;          // of this state at the tick
  double span_s = 0;         // from the state of an earlier tick to this one; 0: no new state in this tick
  double force_delay_s = 0;  // from a command to its arrival at the device
  double delay_s = 0;        // longest recent time from a state until the force that was computed from it acts
  bool at_once = false;      // a force acts on arrival; otherwise from the first state after its arrival
  bool immediate() const { return period_s <= 0; }
};

struct DeviceState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, world
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, world
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      // rad/s, world
  std::int32_t buttons = 0;                            // bit 0 first
  // It does not answer, or sends invalid data: position and orientation are the last valid ones, and no force may
  // be rendered.
  bool lost = false;
  DeviceLoop loop;
};

// On the hand, N and N m, in world axes. The torque is about the position of the device.
struct Wrench {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_N_m = Eigen::Vector3d::Zero();
};

class Device {
 public:
  // The amplifier drops a force that is not renewed within this time, so that a device whose loop stops does not
  // keep pushing.
  static constexpr sync::Nanoseconds kWatchdog{20'000'000};

  virtual ~Device() = default;
  // Sets the clock of this process, before the first message. A device whose messages have stamps uses it.
  virtual void set_clock(const sync::OwnClock&) {}
  // Called when the simulation begins: a device that follows a path starts it at this instant, and stays at its
  // first point before.
  virtual void begin(sync::HostTime) {}
  // State of the hand at `now`. Call once per tick, before write.
  virtual DeviceState read(sync::HostTime now) = 0;
  // Force to render, held until the next write. A device without torque ignores the torque.
  virtual void write(const Wrench& wrench) = 0;
  void write(const Eigen::Vector3d& force_N) { write(Wrench{force_N, Eigen::Vector3d::Zero()}); }

  // Why the device is lost, as a sentence without its end; empty: it is not lost, or the reason is not known.
  virtual std::string problem(sync::HostTime /*now*/) const { return ""; }

  // State of a device that another program drives; implementations accept their own name only.
  virtual void on_message(const device_state_t&, sync::HostTime /*arrival*/) {}
  // Force commands of other processes to such programs: only one process may hold a device.
  virtual void on_message(const device_force_t&, sync::HostTime /*arrival*/) {}
  // Message for such a program after each write; null: none. Valid until the next call of this object.
  virtual device_force_t* force_message() { return nullptr; }
};

}  // namespace tactus::haptic
