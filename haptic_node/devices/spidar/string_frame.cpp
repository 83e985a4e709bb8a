#include "haptic_node/devices/spidar/string_frame.h"

#include <algorithm>

namespace tactus::haptic {
namespace {

// Motors, pulleys and encoders: from the Springhead library of the makers of SPIDAR, for maxon motors with a
// pulley of 8 mm: "measured value" 29.24 um of string per count; minimum tension 0.5 N (desktop), 1 N (room);
// maximum 20 N.
constexpr double kDesktopCount_m = 2.924062107079e-5;
// SPIDAR-G6X3, same source: 16.6555 um, 0.3 to 20 N.
constexpr double kGripCount_m = 1.66555e-5;
// design: a motor of about 5000 rpm on a pulley of 8 mm radius winds 4 m/s.
constexpr double kWinding_m_s = 4;
// design: the current loop of a servo amplifier follows within half a millisecond.
constexpr double kTensionTime_s = 0.5e-3;

StringFrame motors(const char* name, double min_tension_N, double count_m) {
  StringFrame f;
  f.name = name;
  f.min_tension_N = min_tension_N;
  f.max_tension_N = 20;
  f.encoder_step_m = count_m;
  f.winding_speed_m_s = kWinding_m_s;
  f.tension_time_s = kTensionTime_s;
  return f;
}

// Every second corner of a cube of 0.53 m: the anchors of the four-string SPIDAR in the Springhead library.
StringFrame desktop() {
  StringFrame f = motors("desktop", 0.5, kDesktopCount_m);
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(1, 1, 1), {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}})
    f.strings.push_back({0.265 * corner, Eigen::Vector3d::Zero()});
  f.workspace_radius_m = 0.12;  // design: 4 N in every direction; the outward pull ends at 0.15
  return f;
}

// Frame and grip of SPIDAR-G6X3 (12 x 14 x 12 cm; a ball of 45 mm), or larger frames with the same arrangement of
// knots.
StringFrame grip(StringFrame f, const Eigen::Vector3d& half_m, double knot_m) {
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY() * knot_m, up = Eigen::Vector3d::UnitZ() * knot_m;
  for (const int z : {-1, 1}) {
    for (const int x : {-1, 1}) {
      for (const int y : {-1, 1}) {
        const Eigen::Vector3d corner(x * half_m.x(), y * half_m.y(), z * half_m.z());
        f.strings.push_back({corner, x > 0 ? Eigen::Vector3d(y * left) : Eigen::Vector3d(z * up)});
      }
    }
  }
  return f;
}

// Anchors measured on the string device around a multi-projection room (Hashimoto; Springhead library, October
// 2003), rotated into our axes, with the origin at their mean.
StringFrame cave() {
  StringFrame f = motors("cave", 1, kDesktopCount_m);
  for (const Eigen::Vector3d& anchor :
       {Eigen::Vector3d(1.15, 1.68, 2.00), {-1.33, -1.66, 2.16}, {-1.44, 1.65, -1.00}, {1.21, -1.97, -1.045}})
    f.strings.push_back({anchor, Eigen::Vector3d::Zero()});
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const StringEnds& string : f.strings) middle += string.anchor_m / 4;
  for (StringEnds& string : f.strings) string.anchor_m -= middle;
  f.workspace_radius_m = 0.5;  // design: 4 N in every direction
  return f;
}

}  // namespace

double StringFrame::lever_m() const {
  double longest = 0;
  for (const StringEnds& s : strings) longest = std::max(longest, s.knot_m.norm());
  return has_torque() && longest > 0 ? longest : 1;
}

PerString string_lengths(const StringFrame& frame, const GripPose& pose) {
  PerString lengths(frame.size());
  for (int i = 0; i < frame.size(); ++i) {
    const StringEnds& s = frame.strings[static_cast<std::size_t>(i)];
    lengths(i) = (s.anchor_m - pose.position_m - pose.orientation * s.knot_m).norm();
  }
  return lengths;
}

StructureMatrix structure_matrix(const StringFrame& frame, const GripPose& pose) {
  StructureMatrix w(frame.has_torque() ? 6 : 3, frame.size());
  const double lever_m = frame.lever_m();
  for (int i = 0; i < frame.size(); ++i) {
    const StringEnds& s = frame.strings[static_cast<std::size_t>(i)];
    const Eigen::Vector3d arm = pose.orientation * s.knot_m;
    const Eigen::Vector3d along = (s.anchor_m - pose.position_m - arm).normalized();
    w.col(i).head<3>() = along;
    if (frame.has_torque()) w.col(i).tail<3>() = arm.cross(along) / lever_m;
  }
  return w;
}

std::optional<StringFrame> known_frame(std::string_view name) {
  if (name == "desktop") return desktop();
  if (name == "cave") return cave();
  if (name == "desktop8") {
    StringFrame f = grip(motors("desktop8", 0.3, kGripCount_m), {0.06, 0.06, 0.07}, 0.0225);
    f.workspace_radius_m = 0.012;  // design, both: a frame of 12 cm gives 5 N in every direction there
    f.workspace_tilt_rad = 0.26;
    return f;
  }
  // design: the motors of the room on a cuboid about it, and a cross of 20 cm for two hands
  if (name == "cave8") {
    StringFrame f = grip(motors("cave8", 1, kDesktopCount_m), {1.3, 1.7, 1.5}, 0.1);
    f.workspace_radius_m = 0.3;  // design, both: 5 N in every direction
    f.workspace_tilt_rad = 0.17;
    return f;
  }
  return std::nullopt;
}

std::vector<std::string> known_frames() { return {"desktop", "desktop8", "cave", "cave8"}; }

}  // namespace tactus::haptic
