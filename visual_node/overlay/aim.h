// What the mouse points at, for the spot light that follows it. Pure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>

#include "sync/time/time.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/triangles.h"

namespace tactus::visual {

// The nearest opaque surface in the picture at (x, y), shares of its width and height from the upper left: where
// it is, m, world. Nothing: there is none, or no part of the picture shows that place. Tries every triangle: some
// ms for 100,000.
std::optional<Eigen::Vector3f> hit_at(const DrawList& list, std::span<const Triangles> geometries, float x,
                                      float y);

// The device that the mouse is. Whoever steers the lamp listens to it: --device LAMP=external:mouse.
inline constexpr const char* kMouseDevice = "mouse";

// A pointer that follows what is aimed at, no faster than kFastest_m_s: haptic_node believes no device that leaps.
class MousePointer {
 public:
  static constexpr double kFastest_m_s = 5;  // design: a quarter of what a hand is believed

  void aim(const Eigen::Vector3d& at) { target_ = at; }
  // Once a tick from the first aim on: what the device says. Nothing before.
  std::optional<device_state_t> state(sync::HostTime now);

 private:
  std::optional<Eigen::Vector3d> target_;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
  std::optional<sync::HostTime> last_;
};

}  // namespace tactus::visual
