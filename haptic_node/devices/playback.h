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
  // The motion begins with its first sample, and rests at its last.
  void begin(sync::HostTime at) override { begin_ = at; }
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  void write(const Wrench&) override {}

 private:
  MonotoneCubic curve_;
  std::vector<Eigen::Quaterniond> orientations_;
  Placement placement_;
  std::optional<sync::HostTime> begin_;
  // For the spin, which is the turn since the last tick by its time; 0 where the orientation stands still.
  std::optional<std::pair<sync::HostTime, Eigen::Quaterniond>> last_;
  Eigen::Vector3d spin_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::haptic
