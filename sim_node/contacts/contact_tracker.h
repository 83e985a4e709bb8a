// Follows the contacts between bodies from step to step: gives each pair of shapes that touch an identity, says when it
// began, hit and ended, and keeps its state. Pure: poses, velocities and manifolds are arguments.
#pragma once

#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/contacts/contact_math.h"
#include "sim_node/model/ids.h"
#include "sim_node/model/manifold.h"
#include "sim_node/settings.gen.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

// One pair of shapes that touches, or has just touched.
struct LiveContact {
  std::int64_t id = 0;
  Manifold manifold;        // as last seen to touch
  // Its deepest point on each surface, body frames, as last seen.
  Eigen::Vector3d a_body_m = Eigen::Vector3d::Zero(), b_body_m = Eigen::Vector3d::Zero();
  bool touching = true;     // at the newest step; else within the hysteresis
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

  // The contacts at `now`, the end of a step of that length, and those that the step began with, with their forces and
  // impacts; both ordered. Contacts may have gaps: a pair touches when it is nearer than what a solver leaves between
  // surfaces that rest, or when the solver says that it met inside the step. bodies: as they are at `now`; where no
  // solver says how surfaces met, before anything has acted on the new contacts. Appends the events of the step.
  // Realtime-safe once its lists have grown.
  void update(sync::SimTime now, sync::Nanoseconds step, std::span<const BodyMotion> bodies,
              std::span<const Manifold> contacts, std::span<const Manifold> solved, std::vector<contact_event_t>& events);

  std::span<const LiveContact> live() const { return live_; }
  // Those before the last update, once: what is in `into` goes, its room is used.
  void take_previous(std::vector<LiveContact>& into) { std::swap(next_, into); }
  // The contact as a message.
  void describe(const LiveContact& contact, std::span<const BodyMotion> bodies, contact_t& out) const;

  // Contacts of marked bodies (a mark for each of the world) go elsewhere, appended to `out` in order, and come from there.
  // Realtime-safe once the lists have grown.
  void take(std::span<const char> marked, std::vector<LiveContact>& out);
  void put(std::span<const LiveContact> contacts);
  // Says something of a contact that the steps did not: its begin, for who was not told of it.
  void tell(LiveContact& contact, std::int8_t kind, sync::SimTime when, std::span<const BodyMotion> bodies,
            std::vector<contact_event_t>& events);

  // bodies: how many the world has.
  void archive(StateArchive& a, std::size_t bodies);
  void archive(StateArchive& a, LiveContact& contact, std::size_t bodies);
  // The ids have been renamed.
  void rename();

 private:
  // How two surfaces come together, or are when they part.
  struct Meeting {
    double speed_m_s = 0;  // at which they close; negative: they part
    double mass_kg = 0;    // that the meeting feels
    double curvature_1_m = 0;
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ();
  };
  struct Closing {
    const ManifoldPoint* point = nullptr;
    double speed_m_s = 0;
  };
  Closing closing(const Manifold& contact, std::span<const BodyMotion> bodies) const;
  Meeting meeting(const Manifold& contact, std::span<const BodyMotion> bodies) const;
  Meeting meeting(const Manifold& contact, const Impact& impact) const;
  void follow(const LiveContact* before, const Manifold* near, const Manifold* solved, std::span<const BodyMotion> bodies);
  // A hit when the surfaces close fast enough. describe() returns the Meeting; it is called only when an event is emitted.
  template <class DescribeMeeting>
  void meet(LiveContact& c, bool is_new, sync::SimTime when, double speed_m_s, DescribeMeeting describe);
  // True when it has ended.
  bool part(LiveContact& c, const Manifold* near, const Manifold* struck, std::span<const BodyMotion> bodies);
  void remember(LiveContact& c, std::span<const BodyMotion> bodies, bool rolls);
  void emit(LiveContact& c, std::int8_t kind, sync::SimTime when, const Meeting& status);
  double curvature_of(const Manifold& contact, const ManifoldPoint& p, std::span<const BodyMotion> bodies) const;

  std::vector<SurfaceTraits> surfaces_;
  Settings settings_;
  double meets_at_m_;  // surfaces act on each other from this gap on, and touch
  Ids& ids_;
  sync::SimTime now_{};
  sync::Nanoseconds step_{};
  double step_s_ = 0;
  std::vector<LiveContact> live_, next_;
  std::vector<contact_event_t>* events_ = nullptr;
};

}  // namespace tactus::sim
