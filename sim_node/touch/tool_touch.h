// One tool among the bodies: which surfaces it touches or may soon touch, and when its contacts began, hit and ended. The
// tool is a ghost at its proxy's pose; the force is the haptic node's. Pure.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/group_tool.h"
#include "sim_node/touch/shape_search.h"
#include "sim_node/collision/closest_surface.h"
#include "sim_node/contacts/contact_math.h"
#include "sim_node/model/ids.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/collision/sphere_tree.h"
#include "sim_node/settings.gen.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

class ToolTouch {
 public:
  // Whoever tells of a faster one, in a false message, does not make the world look for surfaces everywhere. Design:
  // faster than a hand that feels (a reach is 1 to 2 m/s).
  static constexpr double kFastestHand_m_s = 5;
  // Speed that a unit impulse along n at the point of a body gives to that point, 1/kg.
  using Mobility = std::function<double(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n)>;

  // trees: of this world, where others use them too.
  ToolTouch(const WorldDef& world, int tool, const Settings& settings, Ids& ids, MeshTrees& trees);

  // One step, at `now`. news: messages of this tool since the last step, in order. Appends events.
  void update(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const tool_state_t> news,
              std::vector<contact_event_t>& events);

  // The same while the world stands still: the planes near where the hand is now. Nothing begins, hits or ends.
  void feel(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const tool_state_t> news);

  // The planes, nearest first, whole; pages, header and clock are the publisher's. Tool -1: it only points, and there is none to send.
  const touch_model_t& model() const { return model_; }
  // Gives the model away for another of the same tool, which the next step writes over: nothing is copied.
  void exchange_model(touch_model_t& other) { std::swap(model_, other); }
  // Where the tool is: its proxy, as last heard of.
  const Eigen::Vector3d& proxy() const { return proxy_; }
  const Eigen::Vector3d& proxy_velocity() const { return proxy_velocity_; }
  // Contacts of the tool.
  void describe(std::span<const BodyMotion> bodies, std::vector<contact_t>& out) const;

  // From now on only these bodies that move are looked at, beside what never moves; ascending, and alive until the next
  // call; none: all.
  void look_only_at(std::optional<std::span<const int>> bodies) { only_ = bodies; }
  // False: it only points.
  bool touches() const { return model_.tool >= 0; }
  // As grouping sees it: with the margin within which surfaces are in its model.
  GroupTool for_groups() const { return {proxy_, proxy_velocity_, reach_m()}; }
  // Who knows how easily a body is moved: a link moves with what it is joined to. Else all are taken as free.
  void set_mobility(Mobility mobility) { mobility_ = std::move(mobility); }

  // The friction of a body's shapes against other bodies has been set: that of the tool against them follows.
  void set_friction(int body, double friction);

  void archive(StateArchive& a);
  // The ids have been renamed.
  void rename();

 private:
  struct Surface {
    ClosestSurface shape;
    SurfaceTraits traits;
    Eigen::Isometry3d from_body;     // body frame to shape frame
    Eigen::Vector3d centre_in_body;  // of the sphere around the shape
    double friction_static = 0.5, friction_dynamic = 0.5;  // of the pair
    double compliance_1_Pa = 0;                            // of the pair
    std::int64_t bump_asset = 0;                           // of its material
    bool mapped = false;                                   // that has a map of relief or friction
  };
  // A surface near the tool, followed from step to step.
  struct Near {
    std::int64_t contact_id = 0;
    std::size_t surface = 0;
    SurfacePlane plane;  // world
    Eigen::Vector3d tool_point_m{0, 0, 0};  // of a shape: what meets it, in the tool's frame
    sync::SimTime seen{};
    bool touching = false;
    bool apart = true;  // while touching: within the hysteresis of its end
    sync::SimTime apart_since{}, last_hit{};
    bool has_hit = false;
    double gap_m = 1, force_N = 0, impulse_N_s = 0;
    double device_gap_m = 1;  // of the newest message
    bool device_gap_known = false;
    double closing_m_s = 0;   // speed at which the device came nearer, before
  };

  // Of the device where the tool meets that surface, m/s; a ball has no lever.
  Eigen::Vector3d velocity_of(const Near& n) const {
    return shape_ ? Eigen::Vector3d(velocity_ + spin_.cross(device_turn_ * n.tool_point_m)) : velocity_;
  }
  double reach_m() const {
    const double speed_m_s = std::min(velocity_.norm() + bound_m_ * spin_.norm(), kFastestHand_m_s);
    return bound_m_ + relief_m_ + settings_.touch_margin_m + settings_.touch_margin_time_s * speed_m_s;
  }
  void look_around(sync::SimTime now, std::span<const BodyMotion> bodies);
  void meet(sync::SimTime now, std::size_t surface, const BodyMotion& body, double reach_m);
  void follow(sync::SimTime now, const SurfacePlane& plane, std::size_t surface, const Eigen::Vector3d& tool_point_m);
  void hear(const tool_state_t& m);
  // From the centre of the tool, turned like that, to the place that meets the surface, skin and all.
  Eigen::Vector3d arm(const Near& n, const Eigen::Quaterniond& orientation) const {
    return orientation * n.tool_point_m - radius_m_ * n.plane.normal;
  }
  void take(const tool_state_t& m, sync::SimTime now, std::span<const BodyMotion> bodies,
            std::vector<contact_event_t>& events);
  void judge(Near& n, sync::SimTime when, sync::SimTime before, sync::SimTime now, std::span<const BodyMotion> bodies,
             std::vector<contact_event_t>& events);
  void emit(const Near& n, std::int8_t kind, sync::SimTime when, std::span<const BodyMotion> bodies,
            std::vector<contact_event_t>& events) const;
  void write_model(sync::SimTime now, std::span<const BodyMotion> bodies);
  double mobility_1_kg(const Near& n, std::span<const BodyMotion> bodies) const;
  double mass_kg(const Near& n, std::span<const BodyMotion> bodies) const;
  const BodyMotion& body_of(const Near& n, std::span<const BodyMotion> bodies) const {
    return bodies[static_cast<std::size_t>(surfaces_[n.surface].traits.body)];
  }

  int tool_, tool_body_, tool_material_;
  // Of a ball; a shape touches with its own points, and its bound is that of the ball around it.
  double radius_m_, bound_m_, tool_mass_kg_;
  std::optional<ShapeSearch> shape_;
  std::vector<ToolMeeting> met_;
  double own_static_ = 1, own_dynamic_ = 1;  // friction of the tool's material
  Settings settings_;
  Ids& ids_;
  Mobility mobility_;
  std::vector<Surface> surfaces_;
  // Where to look: the surfaces of bodies that never move, and those of all others.
  SphereTree fixed_;
  struct Moving {
    int surface, body;
    double bound_m;  // about the origin of its body
  };
  std::vector<Moving> moving_;          // by body
  std::vector<std::size_t> first_of_;   // of each body, in moving_; and one past the last
  std::optional<std::span<const int>> only_;
  std::vector<int> candidates_;
  std::vector<Near> near_;
  std::vector<SurfacePlane> found_;
  touch_model_t model_{};

  bool known_ = false;
  Eigen::Vector3d proxy_{0, 0, 0}, device_{0, 0, 0}, velocity_{0, 0, 0}, proxy_velocity_{0, 0, 0};
  // Of a shape; a ball turns without touching anything else.
  double relief_m_ = 0;  // the highest on any surface: a hand may feel a surface so much higher than it is here
  Eigen::Vector3d spin_{0, 0, 0};
  Eigen::Quaterniond proxy_turn_ = Eigen::Quaterniond::Identity(), device_turn_ = Eigen::Quaterniond::Identity();
  sync::SimTime heard_{}, last_stamp_{};
};

}  // namespace tactus::sim
