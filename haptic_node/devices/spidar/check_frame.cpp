#include <sstream>
#include <stdexcept>

#include "haptic_node/devices/spidar/tensions.h"

namespace tactus::haptic {
namespace {

[[noreturn]] void reject(const StringFrame& f, const std::string& what) {
  throw std::runtime_error("string frame \"" + f.name + "\": " + what);
}

void check_number(const StringFrame& f, const char* what, double value, double min, double max) {
  if (value >= min && value <= max) return;
  std::ostringstream out;
  out << what << " is " << value << "; it must be from " << min << " to " << max;
  reject(f, out.str());
}

void check_strings(const StringFrame& f) {
  if (f.size() != 4 && f.size() != 8)
    reject(f, "it has " + std::to_string(f.size()) + " strings; use four on one point or eight on a grip");
  for (std::size_t i = 0; i < f.strings.size(); ++i) {
    const StringEnds& s = f.strings[i];
    const std::string which = "string " + std::to_string(i + 1);
    // Limits: a room for anchors, a two-handed grip for knots.
    if (!s.anchor_m.allFinite() || s.anchor_m.norm() > 20)
      reject(f, which + ": its anchor is not within 20 m; write it in metres");
    if (!s.knot_m.allFinite() || s.knot_m.norm() > 1)
      reject(f, which + ": its knot is not within 1 m; write it in metres");
    if (!f.has_torque() && !s.knot_m.isZero())
      reject(f, which + " does not end at the one point of the grip; omit knot_m with four strings");
    for (std::size_t j = 0; j < i; ++j)
      if ((f.strings[j].anchor_m - s.anchor_m).norm() < 1e-3)
        reject(f, which + " and string " + std::to_string(j + 1) + " have one anchor; move an anchor");
    if (s.anchor_m.norm() < f.workspace_radius_m + s.knot_m.norm())
      reject(f, which + ": its anchor lies inside the workspace; make workspace_radius_m smaller");
  }
}

// Checks the middle and the border in 26 directions, each upright and tilted to either side about each axis.
void check_workspace(const StringFrame& f) {
  const auto check = [&](const Eigen::Vector3d& at, const Eigen::Vector3d& turn) {
    const GripPose pose{at, turn.isZero() ? Eigen::Quaterniond::Identity()
                                          : Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))};
    if (solve_tensions(f, pose, {}).held) return;
    std::ostringstream out;
    if (at.isZero() && turn.isZero())
      out << "the strings cannot hold the grip in the middle: they leave a direction free; move the anchors";
    else
      out << "at (" << at.x() << ", " << at.y() << ", " << at.z() << ") m, tilted by " << turn.norm()
          << " rad, strings that only pull cannot hold the grip; make the workspace smaller or move the anchors";
    reject(f, out.str());
  };
  check(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const Eigen::Vector3d at =
        direction.isZero() ? direction : Eigen::Vector3d(f.workspace_radius_m * direction.normalized());
    check(at, Eigen::Vector3d::Zero());
    for (int axis = 0; axis < 3 && f.has_torque(); ++axis)
      for (const int side : {-1, 1}) check(at, side * f.workspace_tilt_rad * Eigen::Vector3d::Unit(axis));
  }
}

}  // namespace

void check_frame(const StringFrame& f) {
  check_number(f, "min_tension_N", f.min_tension_N, 1e-3, 100);
  check_number(f, "max_tension_N", f.max_tension_N, f.min_tension_N, 500);
  check_number(f, "encoder_step_m", f.encoder_step_m, 1e-9, 0.01);
  check_number(f, "winding_speed_m_s", f.winding_speed_m_s, 0.01, 100);
  check_number(f, "tension_time_s", f.tension_time_s, 1e-6, 1);
  check_number(f, "workspace_radius_m", f.workspace_radius_m, 1e-3, 20);
  check_number(f, "workspace_tilt_rad", f.workspace_tilt_rad, 0, 1.5);
  check_strings(f);
  check_workspace(f);
}

}  // namespace tactus::haptic
