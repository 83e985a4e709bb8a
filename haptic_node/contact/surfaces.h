// The surfaces near the tool as the servo loop renders them: the planes of the touch model, moved on to now, and
// made continuous. A plane that jumps, turns, appears over the proxy or is left out yields within the recovery
// time (Mark et al. 1996), so that a new message never kicks the hand; what changes slowly is followed at once.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <bitset>
#include <cstdint>
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
  double extrapolate_at_most_s = 0.02;
  double surface_speed_limit_m_s = 10;
};

struct Surface {
  std::int64_t contact_id = 0;
  std::int32_t body = -1;
  double effective_mass_kg = 1;
  double stiffness_N_m = 0, damping_N_s_m = 0;  // of the surface itself
  double friction_static = 0, friction_dynamic = 0;
  // As rendered now.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0;  // the tool's centre stays at normal . x >= offset, as it is turned
  Eigen::Vector3d tool_point = Eigen::Vector3d::Zero();  // that meets it, in the tool's frame, m; of a ball 0
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // of the surface, m, world
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
  // How deep the device was pressed under it in the last tick, m; set by whoever solves for the proxy.
  double depth_m = 0;
  MappedPlace mapped;  // in the maps of its material
  // Of a rigid tool, kept from tick to tick, m: the stretch of friction, what a contact that holds is still to be
  // drawn back by, and whether it slips.
  Eigen::Vector3d grip = Eigen::Vector3d::Zero(), owed = Eigen::Vector3d::Zero();
  bool slips = false;
  // Gains of the coupling, kept with the surface so that they change smoothly; set by the renderer.
  double coupling_stiffness_N_m = -1, coupling_damping_N_s_m = 0;

  // Whether pushing it moves it.
  bool moves() const { return effective_mass_kg < 1e9; }
  // Velocity of its material at a place, m/s.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& place) const {
    return velocity + angular_velocity.cross(place - point);
  }

 private:
  friend class Surfaces;
  // As the newest message says, at the instant `at`.
  Eigen::Vector3d told_point_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d told_normal_ = Eigen::Vector3d::UnitZ();
  sync::SimTime at_{};
  double lag_m_ = 0;          // rendered height of the proxy over it, less the true one
  double lag_speed_m_s_ = 0;  // at which the lag goes to zero
  double turn_rad_s_ = 0;     // at which the rendered normal follows
  bool taken_ = false;        // from the newest model
  double leaves_in_s_ = -1;   // time left of one that the model has left out; negative: present
};

// Where the tool is: what meets a surface is a point of it, or its centre, which a skin keeps off.
struct ToolPlace {
  Eigen::Vector3d position;  // m, world
  Eigen::Quaterniond orientation;
  double skin_m;
  // Where it meets a surface, m, world.
  Eigen::Vector3d touched(const Surface& s) const {
    return position + orientation * s.tool_point - skin_m * s.normal;
  }
};

class Surfaces {
 public:
  static constexpr std::size_t kMaxPresent = 50;
  static constexpr std::size_t kMaxOffered = 64;  // of a touch model, the first; on the wire it has 8

  Surfaces(double tool_radius_m, const SurfaceLimits& limits) : radius_m_(tool_radius_m), limits_(limits) {
    list_.reserve(kMaxHalfSpaces + kMaxPresent);
  }

  // One tick. fresh: a touch model that has just arrived, or none. now: the simulated instant, nothing when the
  // map is not known. proxy: where the tool's centre is. at_most: so many planes are taken, those under pressure,
  // deepest first, then the nearest; the others count as left out. Realtime-safe: yes.
  void step(const TouchModelView& fresh, std::optional<sync::SimTime> now, const Eigen::Vector3d& proxy, double dt,
            std::size_t at_most = kMaxPresent);
  void clear() { list_.clear(); }
  // How the tool is turned from now on; without word, not at all.
  void turn(const Eigen::Quaterniond& orientation) { turned_ = orientation.toRotationMatrix(); }

  // At most kMaxHalfSpaces.
  std::span<Surface> list() { return list_; }
  std::span<const Surface> list() const { return list_; }
  // expected: its index, if it is where it was; the search begins there.
  const Surface* find(std::int64_t contact_id, std::size_t expected = 0) const;

 private:
  struct Told {
    Eigen::Vector3d point, normal;
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  // since it was told
  };
  Told predict(const Surface& s) const;
  // place: of the tool, what meets the surface, or its centre where a skin keeps that off.
  double true_height(const Told& told, const Eigen::Vector3d& place) const;
  Eigen::Vector3d place_of(const Eigen::Vector3d& tool_point, const Eigen::Vector3d& proxy) const {
    return proxy + turned_ * tool_point;
  }
  std::bitset<kMaxOffered> choose(const TouchModelView& model, const Eigen::Vector3d& proxy,
                                  std::size_t at_most) const;
  void take(const TouchModelView& model, const Eigen::Vector3d& proxy, std::size_t at_most);
  void take(const touch_plane_t& plane, sync::SimTime at, const Eigen::Vector3d& proxy, std::size_t expected);
  void leave(Surface& s);
  void forget_the_gone();
  void render(Surface& s, const Eigen::Vector3d& proxy, double dt) const;

  double radius_m_;
  SurfaceLimits limits_;
  Eigen::Matrix3d turned_ = Eigen::Matrix3d::Identity();  // the tool, from its frame to the world
  std::optional<sync::SimTime> now_;
  std::vector<Surface> list_;
};

}  // namespace tactus::haptic
