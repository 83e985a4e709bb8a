// The contacts of the bodies that move, with their gaps: what may touch within a step, found before it does. Needs
// no engine.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/collision/detector.h"
#include "sim_node/contacts/friction_maps.h"
#include "sim_node/model/manifold.h"
#include "sim_node/collision/detectors/near_pairs.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Every pair is looked at by the detector that the settings choose, where that takes the pair of kinds, and by `gaps`
// otherwise, and where the surfaces pass through each other, which the chosen one cannot resolve.
class ContactFinder {
 public:
  // Throws std::runtime_error with one sentence when the chosen detector sees no gaps. trees:
  // of this world, where others use them too.
  ContactFinder(const WorldDef& world, const Settings& settings, std::shared_ptr<MeshTrees> trees = nullptr);

  // Contacts of the bodies `active` (ascending numbers of bodies that move) among each other and with all that
  // never moves, into `out`, cleared first. Tools are ghosts and have none; bodies that could move and are not
  // active are not there. Each pair is sought out to the gap that the two may close within h, from their
  // velocities, spins, sizes and gravity, and the contact tolerance. bodies: of all; of those that never move
  // nothing is read. Ordered by (shape_a, shape_b); points reduced to four; depth_m is negative for a gap. Costs
  // what the active bodies do, not all. Deterministic. Realtime-safe once its lists have grown. Not for two
  // threads at once, but two finders may be used by two threads.
  void find(std::span<const BodyMotion> bodies, std::span<const int> active, double h_s,
            std::vector<Manifold>& out);
  // How many shapes the world has.
  std::size_t shapes() const { return body_of_.size(); }

 private:
  void look(const NearPair& pair, std::vector<Manifold>& out);

  NearPairs near_;
  FrictionMaps friction_;
  std::vector<int> body_of_;                 // per shape
  std::vector<ShapeKind> kinds_;             // per shape
  std::unique_ptr<Detector> gaps_, chosen_;  // chosen_: null when it is gaps
  std::vector<int> number_, chosen_number_;  // per shape; -1: none
  std::vector<bool> chosen_takes_;           // by both kinds
  bool only_triangles_ = false;              // the chosen one is asked about meshes only
  std::vector<PointPair> pairs_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace tactus::sim
