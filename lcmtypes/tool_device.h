// Parser of tool_def_t.device and haptic_node --device:
// virtual_hand, virtual_hand:FILE, playback:FILE[,scale=S][,offset=X/Y/Z][,rate=R],
// spidar:NAME|FILE.json[,offset=X/Y/Z] or external:NAME[,offset=X/Y/Z].
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace tactus {

// Options of a recorded motion or of a device frame.
struct Placement {
  double scale = 1;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  // added after scaling; or the origin of the device frame in the world
  double rate = 1;                                     // speed of the playback
};

struct ToolDevice {
  enum class Kind { kVirtualHand, kPlayback, kSpidar, kExternal } kind = Kind::kVirtualHand;
  std::string file;  // file of the motion or of the string frame; empty: none
  std::string name;  // name of a known string frame, or of a device that another program drives; empty: none
  Placement placement;
};

// Maximum size of a motion file: a quarter of an hour at 1 kHz with orientations.
inline constexpr std::uintmax_t kMaxMotionFileBytes = 64 << 20;

// The text does not describe a device; what() is one sentence.
struct BadDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Checks the syntax only, not the file. Throws BadDevice.
ToolDevice parse_tool_device(const std::string& text);

// The same device with another motion or frame file. Throws BadDevice.
std::string with_device_file(const std::string& text, const std::string& file);

}  // namespace tactus
