// Relief and friction maps for touch, at any number of contacts. The two methods of the seed (section 1.9):
//
//   height  the surface stands as high as the map at the touched place; the force keeps its direction
//   normal  the surface stays flat; the force turns to the normal of the map and keeps its magnitude (force
//   shading:
//           Morgenbesser and Srinivasan 1996), so its part along the surface is that of the slope
//
// The normal is that of the displayed picture (lcmtypes/relief.h). It is continuous over the map, and so is the
// force. Neither method stores energy as a true relief does: a user who presses harder downhill than uphill gains
// the difference. The limits of energy and power apply. The account of fixed surfaces (safety/wall_energy.h) contains
// the rest: the force without its tilt, and the depth without the changes of height.
//
// Both methods are limited to the same slope. The force leans no further, and under pressure a height changes by
// at most the motion over the surface times that slope. A relief that appears over the proxy, or jumps, yields as
// surfaces do. Pure.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "haptic_node/contact/surface_maps.h"
#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

struct ReliefDef {
  bool height = false, normal = true;
  double steepest = 1;              // largest rendered slope; the force leans by at most its arctangent
  double recovery_time_s = 0.015;   // transition time of a new method, a loaded map or another side of a body
  double recovery_speed_m_s = 0.1;  // a height that changes more slowly is followed immediately
};
// From the setting `bump`: none, height, normal or both.
ReliefDef relief_def(const std::string& bump, double steepest, double recovery_time_s, double recovery_speed_m_s);

class Reliefs {
 public:
  explicit Reliefs(const ReliefDef& def) : def_(def), height_share_(def.height), normal_share_(def.normal) {}

  // Sets the maps from now on; they fade in. Null: none.
  void set_maps(std::shared_ptr<const SurfaceMaps> maps);
  void change(const ReliefDef& def) { def_ = def; }

  // Call before the proxy moves: sets the height and the friction of each surface from its maps at the touched
  // place. Realtime-safe: yes.
  void apply_heights(std::span<Surface> surfaces, const ToolPose& tool, double dt);
  // Call after the proxy has moved: turns the normal part of each force by the map at the place of the tool.
  // Realtime-safe: yes.
  void tilt_forces(std::span<Surface> surfaces, const ToolPose& tool, std::span<Eigen::Vector3d> forces_N) const;
  // Half of the energy, J, that the changes of height in this tick give to the springs of fixed surfaces at the present
  // depths. Before and after the proxy moves, the sum is exact for springs.
  static double half_energy_of_heights(std::span<const Surface> surfaces);

 private:
  // The touched place in the frame of the body, m.
  static Eigen::Vector3d place_in_body(const Surface& s, const ToolPose& tool);
  void update_height(Surface& s, const Relief& relief, const ToolPose& tool, const Eigen::Vector3d& place_body,
                     double dt) const;
  void update_tilt(MappedPlace& m, const Relief& relief, const Eigen::Vector3d& place_body, double decay) const;
  Eigen::Vector2d slope(const Relief& relief, const MappedPlace& before, const Eigen::Vector2d& at) const;

  ReliefDef def_;
  std::shared_ptr<const SurfaceMaps> maps_;
  double jump_decay_ = 0;               // share of a jump that remains from tick to tick
  double height_share_, normal_share_;  // of each method; follow the setting
};

// The force of a surface as it was before its map tilted it, N: its part along the tilted normal, along the normal.
Eigen::Vector3d without_tilt(const Surface& s, const Eigen::Vector3d& force_N);

}  // namespace tactus::haptic
