// Follows the contacts between bodies from step to step: gives each pair of shapes that touch an identity, says when it
// began, hit and ended, and keeps its state. Pure: poses, velocities and manifolds are arguments.
#pragma once

#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/behaviour/body_motion.h"
#include "sim_node/collision/contact_math.h"
#include "sim_node/collision/ids.h"
#include "sim_node/collision/manifold.h"
#include "sim_node/settings.gen.h"
#include "sim_node/state/state_archive.h"
#include "sync/time.h"

namespace tactus::sim {

// One pair of shapes that touches, or has just touched.
struct LiveContact {
  std::int64_t id = 0;
  Manifold manifold;        // as last seen
  // Its deepest point on each surface, body frames, as last seen.
  Eigen::Vector3d a_body_m = Eigen::Vector3d::Zero(), b_body_m = Eigen::Vector3d::Zero();
  bool touching = true;     // seen at the newest step; else within the hysteresis
  double gap_m = 0;         // while not touching
  double normal_force_N = 0;
  double impulse_N_s = 0;
  bool armed = true;        // slow enough since the last hit for another one
  sync::SimTime last_hit{}, last_event{};
  bool has_hit = false;
  sync::SimTime apart_since{};
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  // centre of its points
  Eigen::Vector3d rolling_m_s = Eigen::Vector3d::Zero();
};

class ContactTracker {
 public:
  ContactTracker(std::vector<SurfaceTraits> surfaces, const Settings& settings, Ids& ids);

  // The contacts at `now`, the end of a step, and those of the step before with their forces, both ordered; bodies as
  // they are at `now`, before anything has acted on the new contacts. Appends the events of the step.
  // Realtime-safe once its lists have grown.
  void update(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const Manifold> contacts,
              std::span<const Manifold> solved, std::vector<contact_event_t>& events);

  std::span<const LiveContact> live() const { return live_; }
  // The contact as a message.
  void describe(const LiveContact& contact, std::span<const BodyMotion> bodies, contact_t& out) const;

  // bodies: how many the world has.
  void archive(StateArchive& a, std::size_t bodies);
  // The ids have been renamed.
  void rename();

 private:
  struct Approach {
    double speed_m_s = 0;  // at which the surfaces close; negative: they part
    const ManifoldPoint* point = nullptr;
  };
  Approach approach(const Manifold& contact, std::span<const BodyMotion> bodies) const;
  void begin(const Manifold& contact, std::span<const BodyMotion> bodies);
  void keep(LiveContact& c, const Manifold& contact, std::span<const BodyMotion> bodies);
  // True when it has ended.
  bool part(LiveContact& c, std::span<const BodyMotion> bodies);
  void meet(LiveContact& c, bool is_new, std::span<const BodyMotion> bodies);
  void remember(LiveContact& c, const Manifold& contact, std::span<const BodyMotion> bodies, bool rolls);
  void emit(LiveContact& c, std::int8_t kind, sync::SimTime when, const Approach& approach,
            std::span<const BodyMotion> bodies);
  double curvature_of(const Manifold& contact, const ManifoldPoint& p, std::span<const BodyMotion> bodies) const;

  std::vector<SurfaceTraits> surfaces_;
  Settings settings_;
  sync::Nanoseconds step_;
  Ids& ids_;
  sync::SimTime now_{};
  std::vector<LiveContact> live_, next_;
  std::vector<contact_event_t>* events_ = nullptr;
};

}  // namespace tactus::sim
