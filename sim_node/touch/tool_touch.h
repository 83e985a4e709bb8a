// Touch detection of one tool: the surfaces that it touches or may soon touch, and the begin, hit and end events of
// its contacts. The tool is a massless body at the pose of its proxy; the haptic node computes the force. Pure.
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
  // Clamp on the reported tool speed, so that a corrupt message cannot widen the search. Design: faster than a hand
  // that explores by touch (a reaching movement has 1 to 2 m/s).
  static constexpr double kMaxToolSpeed_m_s = 5;
  // Speed of a body's point caused by a unit impulse along n at that point, 1/kg.
  using Mobility = std::function<double(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n)>;

  // trees: of this world, shared with other users.
  ToolTouch(const WorldDef& world, int tool, const Settings& settings, Ids& ids, MeshTrees& trees);

  // One step at `now`. new_messages: messages of this tool since the last step, in order. Appends events.
  void update(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const tool_state_t> new_messages,
              std::vector<contact_event_t>& events);

  // The same while the world is paused: finds the planes near the current pose of the tool. No contact begins, hits
  // or ends.
  void update_at_rest(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const tool_state_t> new_messages);

  // All planes, nearest first; the publisher adds pages, header and clock. Tool -1: the tool only points and no model
  // is sent.
  const touch_model_t& model() const { return model_; }
  // Exchanges the model for another of the same tool, which the next step overwrites. Nothing is copied.
  void exchange_model(touch_model_t& other) { std::swap(model_, other); }
  // The proxy position in the newest message.
  const Eigen::Vector3d& proxy() const { return proxy_; }
  const Eigen::Vector3d& proxy_velocity() const { return proxy_velocity_; }
  // Appends the contacts of the tool.
  void describe(std::span<const BodyMotion> bodies, std::vector<contact_t>& out) const;

  // Restricts the search to static bodies and these moving bodies (ascending; the list must live until the next
  // call); none: all bodies.
  void restrict_to(std::optional<std::span<const int>> bodies) { allowed_bodies_ = bodies; }
  // False: the tool only points.
  bool touches() const { return model_.tool >= 0; }
  // The sphere that grouping uses, including the margin of the touch model.
  GroupTool group_tool() const { return {proxy_, proxy_velocity_, reach_m()}; }
  // Sets the source of mobilities, which accounts for joints. Without it every moving body is treated as free.
  void set_mobility(Mobility mobility) { mobility_ = std::move(mobility); }

  // Call when the friction of a body's shapes changes: updates the friction of the tool against them.
  void set_friction(int body, double friction);

  void archive(StateArchive& a);
  // Call after the ids have been renamed.
  void rename();

 private:
  struct Surface {
    ClosestSurface shape;
    SurfaceTraits traits;
    Eigen::Isometry3d from_body;     // body frame to shape frame
    Eigen::Vector3d centre_in_body;  // of the bounding sphere of the shape
    double friction_static = 0.5, friction_dynamic = 0.5;  // of the pair
    double compliance_1_Pa = 0;                            // of the pair
    std::int64_t bump_asset = 0;                           // of its material
    bool mapped = false;                                   // its material has a height map or a friction map
    bool from_afar = false;                                // fixed, and cheap to find at touch_margin_late
  };
  // A surface near the tool, tracked from step to step.
  struct Near {
    std::int64_t contact_id = 0;
    std::size_t surface = 0;
    SurfacePlane plane;  // world
    Eigen::Vector3d tool_point_m{0, 0, 0};  // shaped tool: the point that meets the surface, in the tool's frame
    sync::SimTime last_seen{};
    bool touching = false;
    bool apart = true;  // while touching: within the hysteresis of the end
    sync::SimTime separated_since{}, last_hit{};
    bool has_hit = false;
    double gap_m = 1, force_N = 0, impulse_N_s = 0;
    double device_gap_m = 1;  // in the newest message
    bool has_device_gap = false;
    double closing_m_s = 0;   // approach speed of the device in the previous message
  };

  // Velocity of the device at the point that meets the surface, m/s; a ball has no lever.
  Eigen::Vector3d velocity_of(const Near& n) const {
    return shape_ ? Eigen::Vector3d(velocity_ + spin_.cross(device_orientation_ * n.tool_point_m)) : velocity_;
  }
  double reach_m() const {
    const double speed_m_s = std::min(velocity_.norm() + bound_m_ * spin_.norm(), kMaxToolSpeed_m_s);
    return bound_m_ + relief_m_ + settings_.touch_margin_m + settings_.touch_margin_time_s * speed_m_s;
  }
  // Reach for fixed surfaces. A tool that renders a late model is given them from further away: it may be at them before the
  // next model arrives, and a surface that does not move is as good late as fresh.
  double fixed_reach_m(sync::SimTime now) const {
    return std::max(reach_m(), now < late_until_ ? bound_m_ + relief_m_ + settings_.touch_margin_late_m : 0);
  }
  void find_surfaces(sync::SimTime now, std::span<const BodyMotion> bodies);
  void track_shape(sync::SimTime now, std::size_t surface, const BodyMotion& body, double reach_m);
  void track(sync::SimTime now, const SurfacePlane& plane, std::size_t surface, const Eigen::Vector3d& tool_point_m);
  void set_proxy(const tool_state_t& m, sync::SimTime now);
  // Vector from the centre of the tool, in this orientation, to the point that meets the surface, including the skin.
  Eigen::Vector3d arm(const Near& n, const Eigen::Quaterniond& orientation) const {
    return orientation * n.tool_point_m - radius_m_ * n.plane.normal;
  }
  void receive(const tool_state_t& m, sync::SimTime now, std::span<const BodyMotion> bodies,
            std::vector<contact_event_t>& events);
  void update_contact(Near& n, sync::SimTime when, sync::SimTime before, sync::SimTime now, std::span<const BodyMotion> bodies,
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
  // radius_m_: of a ball; 0 for a shaped tool. bound_m_: of the bounding sphere of the tool.
  double radius_m_, bound_m_, tool_mass_kg_;
  std::optional<ShapeSearch> shape_;
  std::vector<ToolPointPair> pairs_near_;
  double tool_static_friction_ = 1, tool_dynamic_friction_ = 1;  // friction of the tool's material
  Settings settings_;
  Ids& ids_;
  Mobility mobility_;
  std::vector<Surface> surfaces_;
  // Search structures: surfaces of static bodies, and surfaces of all other bodies.
  SphereTree fixed_;
  struct Moving {
    int surface, body;
    double bound_m;  // about the origin of its body
  };
  std::vector<Moving> moving_;          // sorted by body
  std::vector<std::size_t> first_of_;   // index into moving_ for each body, plus one past the last
  std::optional<std::span<const int>> allowed_bodies_;
  std::vector<int> candidates_;
  std::vector<Near> near_;
  std::vector<SurfacePlane> found_;
  touch_model_t model_{};

  bool has_message_ = false;
  Eigen::Vector3d proxy_{0, 0, 0}, device_{0, 0, 0}, velocity_{0, 0, 0}, proxy_velocity_{0, 0, 0};
  // spin_ and orientations are used for a shaped tool only; a ball turns without other contacts.
  double relief_m_ = 0;  // maximum height of any height map: a felt surface may be this much higher than the simulated one
  Eigen::Vector3d spin_{0, 0, 0};
  Eigen::Quaterniond proxy_orientation_ = Eigen::Quaterniond::Identity(), device_orientation_ = Eigen::Quaterniond::Identity();
  sync::SimTime last_message_{}, last_stamp_{};
  sync::SimTime late_until_{};  // the tool has rendered a late model shortly before
};

}  // namespace tactus::sim
