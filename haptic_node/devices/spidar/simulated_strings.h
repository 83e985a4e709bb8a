// A string frame without hardware: a hand moves the grip, strings follow it or hang through, encoders count in
// steps, motors reach their tension late.
#pragma once

#include <memory>
#include <optional>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/spidar/string_motors.h"

namespace tactus::haptic {

class SimulatedStrings : public StringMotors {
 public:
  // hand: holds the grip; its pose is in the world, and so is the force on it. origin_m: of the frame in the
  // world.
  SimulatedStrings(StringFrame frame, const Eigen::Vector3d& origin_m, std::unique_ptr<Device> hand);

  void begin(sync::HostTime at) override { hand_->begin(at); }
  Counts read(sync::HostTime now) override;
  void write(const PerString& tensions_N) override { wanted_N_ = tensions_N; }

  // What the strings really do: for tests and tables.
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
  PerString wound_m_;   // length that is off the pulley; longer than the string is straight: it hangs through
  PerString wanted_N_, tension_N_;
  Wrench felt_;
  std::optional<sync::HostTime> last_;
  bool slack_ = false;
};

}  // namespace tactus::haptic
