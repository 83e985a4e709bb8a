// What holds the hand: a source of pose and a sink of force. Pure: time is an argument, so a device of the real
// world and one of mathematics look the same to the servo loop.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "sync/time/time.h"

namespace tactus::haptic {

struct DeviceState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, world
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, world
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      // rad/s, world
  std::int32_t buttons = 0;                            // bit 0 first
  // It does not answer, or nonsense: position and orientation are the last that were known, and no force may be
  // felt.
  bool lost = false;
};

// On the hand, N and N m, in the axes of the world. The torque is about the position of the device.
struct Wrench {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_N_m = Eigen::Vector3d::Zero();
};

class Device {
 public:
  // A device whose loop stops must not go on pushing: the amplifier drops a force that is not renewed for so long.
  static constexpr sync::Nanoseconds kWatchdog{20'000'000};

  virtual ~Device() = default;
  // The world has begun: a device that follows a path begins it at this instant, and rests at its first point
  // before.
  virtual void begin(sync::HostTime) {}
  // Where the hand is at `now`. Call once a tick, then write once.
  virtual DeviceState read(sync::HostTime now) = 0;
  // What the hand is to feel, held until the next write. A device without torque leaves that out.
  virtual void write(const Wrench& wrench) = 0;
  void write(const Eigen::Vector3d& force_N) { write(Wrench{force_N, Eigen::Vector3d::Zero()}); }

  // What programs on the bus say of devices that they drive; it is for the one of that name.
  virtual void hear(const device_state_t&, sync::HostTime /*arrival*/) {}
  // What other processes tell such programs: a device is held by one.
  virtual void hear(const device_force_t&, sync::HostTime /*arrival*/) {}
  // What such a program must be told after each write; null: nothing. Valid until the next call of this object.
  virtual device_force_t* tell() { return nullptr; }
};

}  // namespace tactus::haptic
