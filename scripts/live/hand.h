// The mouse as a hand in the picture: a place in the picture becomes a place in the world, in the plane in which the tool was
// taken hold of, and the device follows it no faster than a hand. Pure.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>

#include "scripts/live/browser_message.h"
#include "sync/time/time.h"

namespace tactus::live {

// The device that the page is: scripts/run --device external:live.
inline constexpr const char* kHandDevice = "live";

class Hand {
 public:
  // Design: a quick reach; haptic_node itself believes up to 20 m/s and limits what it feels.
  static constexpr double kFastest_m_s = 1;
  // The page repeats where the mouse is every 100 ms. When it has been silent for so long the device says nothing more, is
  // lost to haptic_node, and the force fades to zero (design: three repetitions).
  static constexpr sync::Nanoseconds kSilence{350'000'000};
  // Design: how near to the camera and how far from it the plane may lie.
  static constexpr double kNearest_m = 0.05, kFarthest_m = 10;

  // aspect: width of the picture by its height. tool: where the tool is now, if that is known; only a hand that begins
  // anew looks at it.
  void aim(const HandAt& at, const scene_t& scene, double aspect, const std::optional<Eigen::Vector3d>& tool,
           sync::HostTime now);
  // What the device says now; nothing while no page holds it.
  std::optional<device_state_t> state(sync::HostTime now);

 private:
  double depth_m_ = 0;
  Eigen::Vector3d target_m_ = Eigen::Vector3d::Zero(), at_m_ = Eigen::Vector3d::Zero();
  bool down_ = false;
  std::optional<sync::HostTime> heard_, last_;
};

// Of a point of the picture at that distance along the camera's axis, m, world.
Eigen::Vector3d behind_pixel(const scene_t& scene, double aspect, double x, double y, double depth_m);

}  // namespace tactus::live
