// Makes a device from its description on the command line or in the scene (lcmtypes/tool_device.h). It reads
// files, so do not call it in a loop.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/tool_def_t.hpp>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/playback.h"
#include "haptic_node/devices/spidar/string_frame.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

struct DeviceSpec : ToolDevice {
  std::optional<Motion> motion;      // from the file, if one was named
  std::optional<StringFrame> frame;  // of a spidar
};

// Reads the file, so that errors in it are reported before anything starts. Throws std::runtime_error with one
// sentence.
DeviceSpec parse_device_spec(const std::string& spec);

// A virtual hand without a file, and the hand of a simulated string device, follow the waypoints of the tool.
// Without waypoints they stay at rest_m. Their orientation is `rest`. Throws std::runtime_error when the times of
// the waypoints do not increase.
std::unique_ptr<Device> make_device(const DeviceSpec& spec, const tool_def_t& tool, const Eigen::Vector3d& rest_m,
                                    const Settings& settings,
                                    const Eigen::Quaterniond& rest = Eigen::Quaterniond::Identity());

}  // namespace tactus::haptic
