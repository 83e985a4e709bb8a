// The friction of a pair of surfaces at their contact position, for materials with a friction map.
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
  // Throws std::runtime_error with one clause when an image of the world cannot be read.
  explicit FrictionMaps(const WorldDef& world);

  // Whether a surface of the pair has a friction map.
  bool applies(int shape_a, int shape_b) const {
    return any_ &&
           (shapes_[static_cast<std::size_t>(shape_a)].map || shapes_[static_cast<std::size_t>(shape_b)].map);
  }
  // Transform from the world to the frame of the shape's body. pose: of the shape in the world.
  Eigen::Isometry3d to_body(int shape, const Eigen::Isometry3d& pose) const {
    return shapes_[static_cast<std::size_t>(shape)].in_body * pose.inverse();
  }
  // Sets the friction factor of each point: the geometric mean of the factors of both surfaces, 1 without a map.
  // to_a, to_b: transforms from the world to the body frames. Real-time safe: yes.
  void apply(const Eigen::Isometry3d& to_a, const Eigen::Isometry3d& to_b, Manifold& contact) const;

 private:
  struct Shape {
    std::shared_ptr<const FrictionMap> map;  // null: uniform friction
    Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
  };
  bool any_ = false;
  std::vector<Shape> shapes_;
};

}  // namespace tactus::sim
