// Ray casting for the mouse, which aims a spot light. Pure.
#pragma once

#include <optional>
#include <span>
#include <tactus/device_state_t.hpp>

#include "sync/time/time.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/triangles.h"

namespace tactus::visual {

// The point on the nearest opaque surface in the picture at (x, y), shares of its width and height from the upper
// left. m, world. Nothing: no surface, or no view covers that place. Tests every triangle: some ms for 100,000.
std::optional<Eigen::Vector3d> pick_surface(const DrawList& list, std::span<const Triangles> geometries, float x,
                                            float y);

// Name of the device that the mouse is; it steers a lamp with --device LAMP=external:mouse.
inline constexpr const char* kMouseDevice = "mouse";

// A pointer that follows the aimed point at kMaxSpeed_m_s or less: haptic_node rejects a device that jumps.
class MousePointer {
 public:
  static constexpr double kMaxSpeed_m_s =
      5;  // design: a quarter of the speed that haptic_node accepts from a device

  void aim(const Eigen::Vector3d& at) { target_ = at; }
  // Call once a tick: the state of the device; nothing before the first aim().
  std::optional<device_state_t> state(sync::HostTime now);

 private:
  std::optional<Eigen::Vector3d> target_;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
  std::optional<sync::HostTime> last_;
};

}  // namespace tactus::visual
