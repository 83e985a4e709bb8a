// Contacts of the moving bodies with their gaps: pairs that may touch within a step, detected before they do.
// Independent of the physics engine.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/collision/detector.h"
#include "sim_node/contacts/friction_maps.h"
#include "sim_node/contacts/passing_shapes.h"
#include "sim_node/model/manifold.h"
#include "sim_node/collision/detectors/near_pairs.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Uses the detector that the settings select for the pairs of kinds that it supports. Uses `gaps` for all other
// pairs, and where surfaces intersect, which the selected detector cannot resolve.
class ContactFinder {
 public:
  // Throws std::runtime_error with one sentence when the selected detector reports no gaps. trees: shared trees of
  // this world; null: the finder makes its own.
  ContactFinder(const WorldDef& world, const Settings& settings, std::shared_ptr<MeshTrees> trees = nullptr);

  // Writes the contacts of the bodies `active` (ascending indices of moving bodies) among each other and with all
  // static bodies into `out`, after clearing it. Tools are ghosts without contacts. Inactive moving bodies are
  // ignored. Each pair is searched up to the gap that may close within h_s, from velocities, rotation, sizes and
  // gravity, plus the contact tolerance. The normals of shapes that pass each other are at a right angle to their motion. bodies: of the whole world; entries of static bodies are not read. Ordered
  // by (shape_a, shape_b). Points are reduced to four. depth_m is negative for a gap. The cost depends on the number
  // of active bodies only. Deterministic. Real-time safe once its lists have grown. One finder is not thread-safe;
  // two threads may use two finders.
  void find(std::span<const BodyMotion> bodies, std::span<const int> active, double h_s,
            std::vector<Manifold>& out);
  // Number of shapes of the world.
  std::size_t shapes() const { return body_of_.size(); }

 private:
  void detect_pair(const NearPair& pair, std::vector<Manifold>& out);

  NearPairs near_;
  FrictionMaps friction_;
  PassingShapes passing_;
  std::vector<int> body_of_;                 // per shape
  std::vector<ShapeKind> kinds_;             // per shape
  std::unique_ptr<Detector> gaps_, chosen_;  // chosen_: null when it is `gaps`
  std::vector<int> number_, chosen_number_;  // per shape, index in the detector; -1: none
  std::vector<bool> chosen_supports_;        // by both kinds
  bool only_triangles_ = false;              // the selected detector is used for meshes only
  std::vector<PointPair> pairs_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace tactus::sim
