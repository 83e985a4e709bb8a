// The frame of a string-driven device: motors at fixed points wind strings that hold a grip. With four strings on
// one point the device has a position and a force; with eight strings on a grip with known knots also an
// orientation and a torque. After SPIDAR (Sato, Hirata and Kawarada 1997) and SPIDAR-G (Kim, Hasegawa, Koike and
// Sato 2002).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::haptic {

inline constexpr int kMaxStrings = 8;

// One value per string: lengths in m or tensions in N. Never allocates.
using PerString = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStrings, 1>;
// Column i: force and, with eight strings, torque about the origin of the grip, per newton of tension of string i.
using StructureMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMaxStrings>;

struct GripPose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the origin of the grip in the frame
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct StringEnds {
  Eigen::Vector3d anchor_m;  // exit of the string from the motor, in the frame
  Eigen::Vector3d knot_m;    // point where it is tied, in the grip
};

struct StringFrame {
  std::string name;
  std::vector<StringEnds> strings;  // four with every knot at the origin, or eight
  double min_tension_N = 0;         // a string is slack below it
  double max_tension_N = 0;         // of the motor
  double encoder_step_m = 0;        // length of string per count
  double winding_speed_m_s = 0;     // speed at which an idle motor takes up its string
  double tension_time_s = 0;        // time constant of motor and amplifier
  double workspace_radius_m = 0;    // about the origin of the frame
  double workspace_tilt_rad = 0;    // of the grip from the identity; 0 with four strings

  int size() const { return static_cast<int>(strings.size()); }
  bool has_torque() const { return strings.size() == 8; }
  // Distance at which a torque counts as a force, m: that of the farthest knot; 1 with four strings.
  double lever_m() const;
};

// Lengths of the straight strings. Realtime-safe: yes.
PerString string_lengths(const StringFrame& frame, const GripPose& pose);

// size() columns; three rows, or six with the torque divided by lever_m(). Realtime-safe: yes.
StructureMatrix structure_matrix(const StringFrame& frame, const GripPose& pose);

// desktop, desktop8, cave or cave8; empty for any other name.
std::optional<StringFrame> known_frame(std::string_view name);
// Their names, in this order.
std::vector<std::string> known_frames();

// Throws std::runtime_error with one sentence when no device can use the frame: too few strings, a value out of
// range, anchors that leave a direction free, or a workspace in which strings cannot both pull and hold the grip.
void check_frame(const StringFrame& frame);

}  // namespace tactus::haptic
