// What holds the hand: a source of pose and a sink of force. Pure: time is an argument, so a device of the real
// world and one of mathematics look the same to the servo loop.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "sync/time.h"

namespace tactus::haptic {

struct DeviceState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, world
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, world
  std::int32_t buttons = 0;                            // bit 0 first
};

class Device {
 public:
  // A device whose loop stops must not go on pushing: the amplifier drops a force that is not renewed for so long.
  static constexpr sync::Nanoseconds kWatchdog{20'000'000};

  virtual ~Device() = default;
  // Where the hand is at `now`. Call once a tick, then write once.
  virtual DeviceState read(sync::HostTime now) = 0;
  // Force on the hand, N, world frame, held until the next write.
  virtual void write(const Eigen::Vector3d& force_N) = 0;
};

}  // namespace tactus::haptic
