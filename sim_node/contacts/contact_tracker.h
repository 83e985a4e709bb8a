// Tracks the contacts between bodies from step to step: assigns an identity to each touching pair of shapes, emits
// begin, hit and end, and keeps its state. Pure: poses, velocities and manifolds are arguments.
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

// A pair of shapes that touches or has just separated.
struct LiveContact {
  std::int64_t id = 0;
  Manifold manifold;        // of the last step in which it touched
  // Its deepest point on each surface, body frames, of the last step in which it touched.
  Eigen::Vector3d a_body_m = Eigen::Vector3d::Zero(), b_body_m = Eigen::Vector3d::Zero();
  bool touching = true;     // at the newest step; false within the hysteresis
  double gap_m = 0;         // while not touching
  double normal_force_N = 0;
  double impulse_N_s = 0;
  bool armed = true;        // the approach has been slow enough since the last hit for another one
  sync::SimTime last_hit{}, last_event{};
  bool has_hit = false;
  sync::SimTime separated_since{};
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // centre of its points
  Eigen::Vector3d rolling_m_s = Eigen::Vector3d::Zero();
};

class ContactTracker {
 public:
  ContactTracker(std::vector<SurfaceTraits> surfaces, const Settings& settings, Ids& ids);

  // contacts: the contacts at `now`, the end of a step of this length. solved: those at the start of the step, with
  // their forces and impacts. Both are ordered. Contacts may have gaps: a pair touches when its gap is below the
  // residual that a solver leaves between resting surfaces, or when the solver reports an impact within the step.
  // bodies: the state at `now`; where the solver reports no impacts, the state before it acts on the new contacts.
  // Appends the events of the step. Real-time safe once its lists have grown.
  void update(sync::SimTime now, sync::Nanoseconds step, std::span<const BodyMotion> bodies,
              std::span<const Manifold> contacts, std::span<const Manifold> solved, std::vector<contact_event_t>& events);

  std::span<const LiveContact> live() const { return live_; }
  // Moves out the contacts before the last update; valid once. The old content of `into` is discarded and its memory
  // reused.
  void take_previous(std::vector<LiveContact>& into) { std::swap(next_, into); }
  // Converts the contact to a message.
  void describe(const LiveContact& contact, std::span<const BodyMotion> bodies, contact_t& out) const;

  // Moves the contacts of marked bodies (one mark per body of the world) to the end of `out`, in order, and inserts
  // contacts moved out of another tracker. Real-time safe once the lists have grown.
  void extract(std::span<const char> marked, std::vector<LiveContact>& out);
  void insert(std::span<const LiveContact> contacts);
  // Emits an event that the steps did not emit: the begin of a contact for receivers that did not get it.
  void report(LiveContact& contact, std::int8_t kind, sync::SimTime when, std::span<const BodyMotion> bodies,
            std::vector<contact_event_t>& events);

  // bodies: number of bodies in the world.
  void archive(StateArchive& a, std::size_t bodies);
  void archive(StateArchive& a, LiveContact& contact, std::size_t bodies);
  // Renames the stored ids after Ids::rename().
  void rename();

 private:
  // Relative motion of two surfaces at a begin, hit or end.
  struct Approach {
    double speed_m_s = 0;  // closing speed; negative: separating
    double mass_kg = 0;    // effective mass
    double curvature_1_m = 0;
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ();
  };
  struct Closing {
    const ManifoldPoint* point = nullptr;
    double speed_m_s = 0;
  };
  Closing closing(const Manifold& contact, std::span<const BodyMotion> bodies) const;
  Approach approach(const Manifold& contact, std::span<const BodyMotion> bodies) const;
  Approach approach(const Manifold& contact, const Impact& impact) const;
  void update_pair(const LiveContact* before, const Manifold* near, const Manifold* solved, std::span<const BodyMotion> bodies);
  // Emits a hit when the surfaces close fast enough. describe() returns the Approach; it is called only when an event
  // is emitted.
  template <class DescribeApproach>
  void begin_or_hit(LiveContact& c, bool is_new, sync::SimTime when, double speed_m_s, DescribeApproach describe);
  // Returns true when the contact has ended.
  bool separate(LiveContact& c, const Manifold* near, const Manifold* struck, std::span<const BodyMotion> bodies);
  void store_state(LiveContact& c, std::span<const BodyMotion> bodies, bool rolls);
  void emit(LiveContact& c, std::int8_t kind, sync::SimTime when, const Approach& status);
  double curvature_of(const Manifold& contact, const ManifoldPoint& p, std::span<const BodyMotion> bodies) const;

  std::vector<SurfaceTraits> surfaces_;
  Settings settings_;
  double contact_distance_m_;  // gap at which surfaces start to interact and count as touching
  Ids& ids_;
  sync::SimTime now_{};
  sync::Nanoseconds step_{};
  double step_s_ = 0;
  std::vector<LiveContact> live_, next_;
  std::vector<contact_event_t>* events_ = nullptr;
};

}  // namespace tactus::sim
