// Relief and friction maps under the hand. The seed's two methods (section 1.9), at any number of contacts:
//
//   height   the surface stands as high as the map says at the place that is touched; the force keeps its
//   direction normal   the surface stays flat; the force turns to the map's normal and keeps its size (force
//   shading:
//            Morgenbesser and Srinivasan 1996), so its part along the surface is that of the slope
//
// The normal is the picture's (lcmtypes/relief.h). It is continuous over the map, so the force is. Neither method
// stores energy as a true relief does: who presses harder downhill than uphill is given the difference; the limits
// of energy and power hold.
//
// Both are felt up to the same slope: the force leans no further, and under pressure a height rises and falls no
// faster than the way over the surface times that slope. What appears over the proxy, or jumps, yields as surfaces
// do. Pure.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "haptic_node/contact/surface_maps.h"
#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

struct ReliefDef {
  bool height = false, normal = true;
  double steepest = 1;              // slopes are felt up to this, so the force leans by at most atan of it
  double recovery_time_s = 0.015;   // in which a method, a map that has come, or another side of a body sets in
  double recovery_speed_m_s = 0.1;  // a height that changes more slowly is followed at once
};
// of the setting `bump`: none, height, normal or both.
ReliefDef relief_def(const std::string& bump, double steepest, double recovery_time_s, double recovery_speed_m_s);

class Reliefs {
 public:
  explicit Reliefs(const ReliefDef& def) : def_(def), height_share_(def.height), normal_share_(def.normal) {}

  // From now on. Null: none. They set in smoothly.
  void set_maps(std::shared_ptr<const SurfaceMaps> maps);
  void change(const ReliefDef& def) { def_ = def; }

  // Before the proxy moves: raises each surface and sets its friction as its maps say where the tool
  // touches it. Realtime-safe: yes.
  void look(std::span<Surface> surfaces, const ToolPlace& tool, double dt);
  // When it has: turns the part of each force that is along its surface's normal, as the map says where the tool
  // is now. Realtime-safe: yes.
  void lean(std::span<Surface> surfaces, const ToolPlace& tool, std::span<Eigen::Vector3d> forces_N) const;

 private:
  // Where it is touched, in the frame of its body, m.
  static Eigen::Vector3d place(const Surface& s, const ToolPlace& tool);
  void raise(Surface& s, const Relief& relief, const ToolPlace& tool, const Eigen::Vector3d& place_body,
             double dt) const;
  void tilt(MappedPlace& m, const Relief& relief, const Eigen::Vector3d& place_body, double kept) const;
  Eigen::Vector2d slope(const Relief& relief, const MappedPlace& before, const Eigen::Vector2d& at) const;

  ReliefDef def_;
  std::shared_ptr<const SurfaceMaps> maps_;
  double kept_ = 0;                     // of what is left of a jump, from tick to tick
  double height_share_, normal_share_;  // of each method, follows what is wanted
};

}  // namespace tactus::haptic
