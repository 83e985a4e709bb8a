// Makes a device from what a person or a scene writes (lcmtypes/tool_device.h). It reads files: not for a loop.
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
  std::optional<Motion> motion;      // of the file, if one was named
  std::optional<StringFrame> frame;  // of a spidar
};

// Reads the file, so that what is wrong with it is known before anything starts. Throws std::runtime_error with
// one sentence.
DeviceSpec parse_device_spec(const std::string& spec);

// A virtual hand without a file, and the hand that holds a simulated string device, follows the waypoints of the
// tool; without waypoints it rests at rest_m; it is held as `rest` is turned. Throws std::runtime_error when the
// waypoints' times do not increase.
std::unique_ptr<Device> make_device(const DeviceSpec& spec, const tool_def_t& tool, const Eigen::Vector3d& rest_m,
                                    const Settings& settings,
                                    const Eigen::Quaterniond& rest = Eigen::Quaterniond::Identity());

}  // namespace tactus::haptic
