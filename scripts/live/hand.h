// The mouse as a hand in the picture: maps a place in the picture to a place in the world, in the plane in which the tool was
// grabbed; the device follows it with at most the speed of a hand. Pure.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>

#include "scripts/live/browser_message.h"
#include "sync/time/time.h"

namespace tactus::live {

// The name of the page's device: scripts/run --device external:live.
inline constexpr const char* kHandDevice = "live";

class Hand {
 public:
  // Design: a quick reach; haptic_node accepts up to 20 m/s and limits its force.
  static constexpr double kMaxSpeed_m_s = 1;
  // The page repeats the mouse position every 50 ms (page/src/picture.ts). After this silence the device stops publishing;
  // haptic_node loses it, and the force fades to zero (design: seven repetitions).
  static constexpr sync::Nanoseconds kTimeout{350'000'000};
  // Design: limits of the distance between the camera and the plane.
  static constexpr double kMinDepth_m = 0.05, kMaxDepth_m = 10;

  // aspect: width of the picture by its height. tool: the current position of the tool, if known; only a new grab uses it.
  void aim(const HandTarget& at, const scene_t& scene, double aspect, const std::optional<Eigen::Vector3d>& tool,
           sync::HostTime now);
  // The device state to publish now; nullopt while no page holds the device.
  std::optional<device_state_t> state(sync::HostTime now);

 private:
  double depth_m_ = 0;
  Eigen::Vector3d target_m_ = Eigen::Vector3d::Zero(), at_m_ = Eigen::Vector3d::Zero();
  bool down_ = false;
  std::optional<sync::HostTime> last_input_, last_step_;
};

// The place behind a point of the picture, at that distance along the camera's axis, m, world.
Eigen::Vector3d unproject(const scene_t& scene, double aspect, double x, double y, double depth_m);

}  // namespace tactus::live
