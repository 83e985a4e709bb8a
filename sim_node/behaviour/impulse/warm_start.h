// Warm start: impulses of the previous step for persistent points. Resting contacts converge immediately, and a
// stack over several steps.
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
  // Sets point.impulse from the force of the nearest point, in the frame of the moving body, of the same pair of
  // shapes and the same face. The impulse lies in the friction cone. contacts: those of the groups, ordered by their shapes. poses: of every body, at the start of the step.
  void recall(std::span<const Manifold> contacts, std::span<const BodyMotion> poses, ContactRows& rows) const;
  // Stores the impulses of this step.
  void store(std::span<const Manifold> contacts, std::span<const BodyMotion> poses, const ContactRows& rows);
  void clear() { stored_.clear(); }
  void archive(StateArchive& a, std::size_t shapes);

 private:
  struct StoredPoint {
    int shape_a = -1, shape_b = -1;
    Eigen::Vector3d position_m;  // in the frame of the moving body
    Eigen::Vector3d normal;   // world
    Eigen::Vector3d force_N;  // world, on b
    double shell_m = -1;      // as in ContactPoint
  };
  std::vector<StoredPoint> stored_;
};

}  // namespace tactus::sim::impulse
