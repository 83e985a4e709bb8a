// A device that imposes a recorded motion and ignores the force: the same stroke for every condition of a study.
#pragma once

#include <optional>
#include <utility>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/monotone_cubic.h"
#include "haptic_node/devices/motion_file.h"
#include "lcmtypes/tool_device.h"

namespace tactus::haptic {

class Playback : public Device {
 public:
  Playback(Motion motion, const Placement& placement);
  // The motion begins with its first sample, and stays at its last.
  void begin(sync::HostTime at) override { begin_ = at; }
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  void write(const Wrench&) override {}

 private:
  MonotoneCubic curve_;
  std::vector<Eigen::Quaterniond> orientations_;
  Placement placement_;
  std::optional<sync::HostTime> begin_;
  // For the spin: the rotation since the last tick divided by its duration; 0 while the orientation is constant.
  std::optional<std::pair<sync::HostTime, Eigen::Quaterniond>> last_;
  Eigen::Vector3d spin_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::haptic
