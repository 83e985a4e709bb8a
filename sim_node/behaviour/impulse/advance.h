// A step of an impulse world after which nothing is in anything: the backstop behind contacts with gaps. Those are
// linear: they say how far surfaces may close along their normals. What turns far within the step, what is struck
// towards something that nobody expected it to reach, and what the sweeps left unsolved is found afterwards, at
// the new poses, whose contacts the next step needs anyway; only then is the step divided or taken back (after
// Mirtich 1996, "Impulse-based dynamic simulation", section 2: no step leads past the next contact).
#pragma once

#include <span>
#include <vector>

#include "sim_node/behaviour/impulse/step_report.h"
#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/manifold.h"

namespace tactus::sim::impulse {

// Finds contacts for a step of h_s that begins with these motions (as World::motions() gives them: places are
// those of centres of mass), out to where it may lead.
class ContactSource {
 public:
  virtual ~ContactSource() = default;
  virtual void find(std::span<const BodyMotion> motions, std::span<const int> active_bodies, double h_s,
                    std::vector<Manifold>& out) = 0;
};

// How far a body reaches from its centre of mass, m: bound: all of it; bend: what turning moves, less than bound
// for balls, which turning leaves as they are.
struct Extent {
  double bound_m = 0, bend_m = 0;
};

class Advance {
 public:
  // extents: of every body of the world.
  explicit Advance(std::vector<Extent> extents) : extents_(std::move(extents)) {}

  // How far ahead contacts are to be sought for a step of h_s: all of it, or less when something is fast.
  double horizon_s(const World& world, double h_s) const;

  // contacts: of the present poses, found for a step of horizon_s(); those of the new poses afterwards, for a step of
  // next_h_s, or of h_s again. solved: what the step did to them. Realtime-safe once its lists have grown.
  const StepReport& step(World& world, ContactSource& source, double h_s, std::vector<Manifold>& contacts,
                         std::vector<Manifold>& solved, double next_h_s = 0);

 private:
  // One try of a piece of dt: false: it was taken back, and dt or the contacts have changed.
  bool attempt(World& world, ContactSource& source, double& dt, double finest_s, double next_h_s,
               std::vector<Manifold>& contacts);
  int pieces_for(const World& world, std::span<const Manifold> contacts, double dt) const;
  bool came_further(const World& world, double dt);
  bool lacks_pair(std::span<const Manifold> contacts) const;
  double worst(std::span<const Manifold> before, double limit_m) const;
  void clear_overlaps(World& world, ContactSource& source, double next_s);
  void hold_back(World& world, ContactSource& source, double next_s, std::span<const Manifold> before);
  void add_to(std::vector<Manifold>& solved, std::span<const Manifold> piece, double begun_s, double dt,
              double h_s);

  std::vector<Extent> extents_;
  World::Kept kept_;
  std::vector<BodyMotion>
      assumed_;  // motions at the start of a piece, with the speeds that contacts were sought for
  std::vector<Manifold> after_, ahead_, merged_;
  std::vector<int> held_;
  StepReport report_;
};

}  // namespace tactus::sim::impulse
