// A device that imposes a recorded motion and ignores the force: the same stroke for every condition of a study.
#pragma once

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/monotone_cubic.h"
#include "haptic_node/devices/motion_file.h"
#include "lcmtypes/tool_device.h"

namespace tactus::haptic {

class Playback : public Device {
 public:
  Playback(Motion motion, const Placement& placement);
  // The motion begins with its first sample at the first read, and rests at its last.
  DeviceState read(sync::HostTime now) override;
  void write(const Eigen::Vector3d&) override {}

 private:
  MonotoneCubic curve_;
  std::vector<Eigen::Quaterniond> orientations_;
  Placement placement_;
  bool begun_ = false;
  sync::HostTime start_{};
};

}  // namespace tactus::haptic
