// A simulated string frame: a hand moves the grip, strings follow it or go slack, encoders count in steps, and
// motors reach their tension with a delay.
#pragma once

#include <memory>
#include <optional>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/spidar/string_motors.h"

namespace tactus::haptic {

class SimulatedStrings : public StringMotors {
 public:
  // hand: holds the grip; its pose and the force on it are in the world frame. origin_m: origin of the frame in
  // the world.
  SimulatedStrings(StringFrame frame, const Eigen::Vector3d& origin_m, std::unique_ptr<Device> hand);

  void begin(sync::HostTime at) override { hand_->begin(at); }
  Counts read(sync::HostTime now) override;
  void write(const PerString& tensions_N) override { wanted_N_ = tensions_N; }

  // True state of the strings, for tests and tables.
  const DeviceState& hand() const { return state_; }
  const Eigen::Vector3d& force_N() const { return felt_.force_N; }
  const Eigen::Vector3d& torque_N_m() const { return felt_.torque_N_m; }
  bool slack() const { return slack_; }

 private:
  StringFrame frame_;
  Eigen::Vector3d origin_m_;
  std::unique_ptr<Device> hand_;
  DeviceState state_;
  PerString middle_m_;  // lengths where the counts are 0
  PerString wound_m_;   // unwound length; longer than the straight string: it is slack
  PerString wanted_N_, tension_N_;
  Wrench felt_;
  std::optional<sync::HostTime> last_;
  bool slack_ = false;
};

}  // namespace tactus::haptic
