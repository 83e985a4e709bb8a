// The surfaces near the tool as the servo loop renders them: the planes of the touch model, extrapolated to now
// and made continuous. A plane that jumps, turns, appears over the proxy or disappears yields within the recovery
// time (Mark et al. 1996), so that a new message never kicks the hand. Slow changes are followed immediately.
#pragma once

#include <Eigen/Geometry>
#include <bitset>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/contact/closest_point.h"
#include "haptic_node/contact/mapped_place.h"
#include "haptic_node/contact/touch_model_view.h"
#include "sync/time/time.h"

namespace tactus::haptic {

struct SurfaceLimits {
  double recovery_time_s = 0.015;
  double recovery_speed_m_s = 0.1;
  double recovery_turn_rad_s = 30;
  double max_extrapolation_s = 0.02;
  double surface_speed_limit_m_s = 10;
};

struct Surface {
  std::int64_t contact_id = 0;
  std::int32_t body = -1;
  double effective_mass_kg = 1;
  double stiffness_N_m = 0, damping_N_s_m = 0;  // of the surface itself
  double friction_static = 0, friction_dynamic = 0;
  // The plane that is rendered now.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0;  // the centre of the tool stays at normal . x >= offset, for its current orientation
  Eigen::Vector3d tool_point = Eigen::Vector3d::Zero();  // contact point in the frame of the tool, m; 0 for a ball
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // on the surface, m, world
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
  // Depth of the device under the surface in the last tick, m; set by the solver of the proxy.
  double depth_m = 0;
  // Depth at which the tool was under the surface when it appeared, m: geometric, not a multiplier of the solver. The hand
  // gave no energy for it.
  double appeared_m = 0;
  MappedPlace mapped;  // in the maps of its material
  // Friction state for a rigid tool, kept between ticks: the displacement of friction, m; the remaining correction
  // of a contact that holds, m; whether it slips.
  Eigen::Vector3d grip = Eigen::Vector3d::Zero(), stick_error = Eigen::Vector3d::Zero();
  bool slipping = false;
  // It appeared deep above the hand. It is then as stiff as any other, from where the hand is: it rises only as far as the
  // energy account allows (Surfaces::set_rise), and follows a hand that leaves.
  bool held = false;
  // Gains of the coupling, kept with the surface so that they change smoothly; set by the renderer.
  double coupling_stiffness_N_m = -1, coupling_damping_N_s_m = 0;

  // True when a push moves the body.
  bool movable() const { return effective_mass_kg < 1e9; }
  // True when neither a push nor its own motion moves it: a late report of it is as good as a fresh one.
  bool still() const { return !movable() && velocity.isZero(0) && angular_velocity.isZero(0); }
  // Velocity of its material at a place, m/s.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& place) const {
    return velocity + angular_velocity.cross(place - point);
  }

 private:
  friend class Surfaces;
  // The plane of the newest message, at its instant `at`.
  Eigen::Vector3d published_point_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d published_normal_ = Eigen::Vector3d::UnitZ();
  sync::SimTime at_{};
  double lag_m_ = 0;          // rendered height of the proxy over it, minus the true height
  double lag_speed_m_s_ = 0;  // speed at which the lag goes to zero
  double normal_rate_rad_s_ = 0;  // rate at which the rendered normal follows
  bool in_model_ = false;         // in the newest model
  double remaining_s_ = -1;  // remaining time of a surface that the model no longer contains; negative: present
};

// Pose of the tool. A surface meets one of its points, or its centre at the distance skin_m.
struct ToolPose {
  Eigen::Vector3d position;  // m, world
  Eigen::Quaterniond orientation;
  double skin_m;
  // Contact point with a surface, m, world.
  Eigen::Vector3d contact_point(const Surface& s) const {
    return position + orientation * s.tool_point - skin_m * s.normal;
  }
};

class Surfaces {
 public:
  static constexpr std::size_t kMaxPresent = 50;
  // planes of a touch model that are read, the first ones; a message has 8
  static constexpr std::size_t kMaxOffered = 64;

  Surfaces(double tool_radius_m, const SurfaceLimits& limits) : radius_m_(tool_radius_m), limits_(limits) {
    list_.reserve(kMaxHalfSpaces + kMaxPresent);
  }

  // One tick. fresh: a touch model that has just arrived, or none. now: the simulated instant, nothing when the
  // map is not known. proxy: centre of the tool. max_planes: number of planes that are used: those under pressure,
  // deepest first, then the nearest; the others are omitted. Realtime-safe: yes.
  void step(const TouchModelView& fresh, std::optional<sync::SimTime> now, const Eigen::Vector3d& proxy, double dt,
            std::size_t max_planes = kMaxPresent);
  void clear() { list_.clear(); }
  // How fixed surfaces that appear above the hand rise, from now on; initially without a limit. deep_m: those that appear
  // deeper are held. energy_J: that the springs of a held surface may gain in a tick because it rises.
  void set_rise(double deep_m, double energy_J) { deep_m_ = deep_m, rise_J_ = energy_J; }
  // Sets the orientation of the tool from now on; initially the identity.
  void set_orientation(const Eigen::Quaterniond& orientation) { rotation_ = orientation.toRotationMatrix(); }

  // At most kMaxHalfSpaces.
  std::span<Surface> list() { return list_; }
  std::span<const Surface> list() const { return list_; }
  // expected: its likely index; the search begins there.
  const Surface* find(std::int64_t contact_id, std::size_t expected = 0) const;

 private:
  struct PredictedPlane {
    Eigen::Vector3d point, normal;
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // rotation since the message
  };
  PredictedPlane predict(const Surface& s) const;
  // place: the tool point that meets the surface, or the centre of a ball, which stays skin_m away.
  double true_height(const PredictedPlane& predicted, const Eigen::Vector3d& place) const;
  Eigen::Vector3d tool_point_at(const Eigen::Vector3d& tool_point, const Eigen::Vector3d& proxy) const {
    return proxy + rotation_ * tool_point;
  }
  std::bitset<kMaxOffered> select_planes(const TouchModelView& model, const Eigen::Vector3d& proxy,
                                         std::size_t max_planes) const;
  void update(const TouchModelView& model, const Eigen::Vector3d& proxy, std::size_t max_planes);
  void update(const touch_plane_t& plane, sync::SimTime at, const Eigen::Vector3d& proxy, std::size_t expected);
  void continue_renamed(const TouchModelView& model, const std::bitset<kMaxOffered>& chosen, const Eigen::Vector3d& proxy);
  void start_removal(Surface& s);
  void remove_expired();
  void render(Surface& s, const Eigen::Vector3d& proxy, double dt) const;
  void rise(Surface& s, double height_m, double dt) const;

  double radius_m_;
  SurfaceLimits limits_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();  // of the tool, from its frame to the world
  std::optional<sync::SimTime> now_;
  double deep_m_ = std::numeric_limits<double>::infinity(), rise_J_ = deep_m_;
  std::vector<Surface> list_;
};

}  // namespace tactus::haptic
