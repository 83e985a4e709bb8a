// The friction of a pair of surfaces at the place where they touch, where a material of theirs has a friction map.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "lcmtypes/friction_map.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

class FrictionMaps {
 public:
  // Throws std::runtime_error with one clause when a picture of the world cannot be read.
  explicit FrictionMaps(const WorldDef& world);

  // False: the pair has one friction everywhere.
  bool concern(int shape_a, int shape_b) const {
    return any_ &&
           (shapes_[static_cast<std::size_t>(shape_a)].map || shapes_[static_cast<std::size_t>(shape_b)].map);
  }
  // From the world to the frame of its body, of a shape at a pose in the world.
  Eigen::Isometry3d to_body(int shape, const Eigen::Isometry3d& pose) const {
    return shapes_[static_cast<std::size_t>(shape)].in_body * pose.inverse();
  }
  // Sets the factor of each point on the friction of the pair: the root of those of both surfaces, 1 without a
  // map. to_a, to_b: from the world to the frames of the bodies. Realtime-safe: yes.
  void look(const Eigen::Isometry3d& to_a, const Eigen::Isometry3d& to_b, Manifold& contact) const;

 private:
  struct Shape {
    std::shared_ptr<const FrictionMap> map;  // null: the same everywhere
    Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
  };
  bool any_ = false;
  std::vector<Shape> shapes_;
};

}  // namespace tactus::sim
