// What tool_def_t.device and haptic_node --device say:
// virtual_hand, virtual_hand:FILE, playback:FILE[,scale=S][,offset=X/Y/Z][,rate=R],
// spidar:NAME|FILE.json[,offset=X/Y/Z] or external:NAME[,offset=X/Y/Z].
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace tactus {

// How a recorded motion is played, or where a frame stands.
struct Placement {
  double scale = 1;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  // added after scaling; of the frame's origin in the world
  double rate = 1;                                     // speed of the playback
};

struct ToolDevice {
  enum class Kind { kVirtualHand, kPlayback, kSpidar, kExternal } kind = Kind::kVirtualHand;
  std::string file;  // of the motion or of the string frame; empty: none
  std::string name;  // of a known string frame, or of a device that another program drives; empty: none
  Placement placement;
};

// No motion file is larger: a quarter of an hour at 1 kHz with orientations.
inline constexpr std::uintmax_t kMaxMotionFileBytes = 64 << 20;

// What is said is no device; one sentence.
struct BadDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Looks at the form only, not at the file. Throws BadDevice.
ToolDevice parse_tool_device(const std::string& text);

// The same device with its motion or its frame in another file. Throws BadDevice.
std::string with_device_file(const std::string& text, const std::string& file);

}  // namespace tactus
