// Step of an impulse world with a guarantee against penetration: the backstop behind contacts with gaps. Contacts
// are linear: they limit how far surfaces may close along their normals. Fast rotation, impacts on bodies beyond
// the searched range, and residuals of the sweeps are detected afterwards at the new poses, whose contacts the
// next step needs anyway. Only then is the step divided or taken back (after Mirtich 1996, "Impulse-based dynamic
// simulation", section 2: no step passes the next contact).
#pragma once

#include <span>
#include <vector>

#include "sim_node/behaviour/impulse/recovery_report.h"
#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/manifold.h"

namespace tactus::sim::impulse {

// Finds contacts for a step of h_s that starts with these motions, within the range of the step. Positions are
// centres of mass, as in World::motions().
class ContactSource {
 public:
  virtual ~ContactSource() = default;
  virtual void find(std::span<const BodyMotion> motions, std::span<const int> active_bodies, double h_s,
                    std::vector<Manifold>& out) = 0;
};

// Extent of a body from its centre of mass, m. bound: bounding radius. bend: lever arm of the points that rotation
// moves; smaller than bound for balls, whose surface does not change with rotation.
struct Extent {
  double bound_m = 0, rotation_lever_m = 0;
};

class AdaptiveStepper {
 public:
  // extents: of every body of the world.
  explicit AdaptiveStepper(std::vector<Extent> extents) : extents_(std::move(extents)) {}

  // Look-ahead time of the contact search for a step of h_s: the whole step, or less with fast bodies.
  double horizon_s(const World& world, double h_s) const;

  // contacts: in, the contacts of the current poses, found for a step of horizon_s(); out, those of the new poses,
  // for a step of next_h_s, or of h_s again. solved: the contacts of the step with forces and impacts. Real-time
  // safe once its lists have grown.
  const RecoveryReport& step(World& world, ContactSource& source, double h_s, std::vector<Manifold>& contacts,
                             std::vector<Manifold>& solved, double next_h_s = 0);

 private:
  // Tries one substep of dt. Returns false when it was taken back; dt or the contacts have then changed.
  bool try_substep(World& world, ContactSource& source, double& dt, double finest_s, double next_h_s,
                   std::vector<Manifold>& contacts);
  int substeps_for(const World& world, std::span<const Manifold> contacts, double dt) const;
  bool moved_too_far(const World& world, double dt);
  bool has_new_pair(std::span<const Manifold> contacts) const;
  double max_new_overlap_m(std::span<const Manifold> before, double limit_m) const;
  void resolve_overlaps(World& world, ContactSource& source, double next_s);
  void reset_overlapping_units(World& world, ContactSource& source, double next_s, double dt,
                               std::span<const Manifold> before);
  void merge_substep(std::vector<Manifold>& solved, std::span<const Manifold> substep, double begun_s, double dt,
                     double h_s);

  std::vector<Extent> extents_;
  World::SavedStep saved_;
  std::vector<BodyMotion> assumed_;  // motions at the start of a substep, with the speeds of the contact search
  std::vector<Manifold> new_contacts_, repeated_search_, merged_;
  std::vector<int> reset_units_;
  RecoveryReport report_;
};

}  // namespace tactus::sim::impulse
