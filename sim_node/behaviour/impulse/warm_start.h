// Impulses of the step before, for the points that are still there: the solver starts from them, so that what
// rests has its answer at once and a stack gathers it over the steps.
#pragma once

#include <span>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/behaviour/impulse/contact_rows.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim::impulse {

class WarmStart {
 public:
  // Sets point.impulse from the force of the point of the same pair of shapes that lies nearest in the moving
  // body. contacts: ordered by their shapes, those of the groups; poses: of every body, at the start of the step.
  void recall(std::span<const Manifold> contacts, std::span<const BodyMotion> poses, ContactRows& rows) const;
  // Keeps those that were found.
  void keep(std::span<const Manifold> contacts, std::span<const BodyMotion> poses, const ContactRows& rows);
  void clear() { kept_.clear(); }
  void archive(StateArchive& a, std::size_t shapes);

 private:
  struct Kept {
    int shape_a = -1, shape_b = -1;
    Eigen::Vector3d place_m;  // in the frame of the body that moves
    Eigen::Vector3d force_N;  // world, on b
    double shell_m = -1;      // as of its point
  };
  std::vector<Kept> kept_;
};

}  // namespace tactus::sim::impulse
