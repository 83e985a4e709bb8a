// Broad phase: which shapes may touch within a step. Static shapes are indexed once. Moving shapes use sweep and
// prune along the axis of the largest spread. Pure and deterministic.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/model/bounds_grid.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

struct NearPair {
  int shape_a, shape_b;  // body_a < body_b
  double reach_m;        // by which the gap may close within the step, impacts included, plus the tolerance
};

class NearPairs {
 public:
  // tolerance_m: shapes with a smaller gap are a pair even at rest.
  NearPairs(const WorldDef& world, double tolerance_m, MeshTrees& trees);
  // Sorted by shape_a, then shape_b. Real-time safe once the lists have grown.
  std::span<const NearPair> find(std::span<const BodyMotion> bodies, std::span<const int> active, double h_s);
  // World pose of each shape. Poses of active moving shapes are those of the last find().
  const Eigen::Isometry3d& pose(int shape) const { return poses_[static_cast<std::size_t>(shape)]; }

 private:
  struct Extent {  // of a shape, in its own frame
    Eigen::Vector3d middle_m{0, 0, 0}, half_m{0, 0, 0};
    double round_m = 0;
    double lever_m = 0;  // of the points that rotation moves, from the centre of mass; round shapes have less
  };
  struct HalfSpace {
    int shape;
    Eigen::Vector3d normal;
    double offset_m;
  };
  struct Swept {
    int shape, body;
    Bounds bounds;       // swept over the step, enlarged by half the tolerance
    double grown_m = 0;  // enlargement for impacts, included in the bounds
  };
  struct Span {  // interval of a swept shape on the axis
    double min_m, max_m;
    std::size_t swept;
  };
  static Extent extent_of(const ShapeDef& shape, const WorldDef& world, MeshTrees& trees);
  Bounds bounds_of_shape(int shape) const;
  void place(const BodyMotion& m, int body, double h_s);
  void pair_with_fixed(std::size_t i, std::span<const BodyMotion> bodies, double h_s);
  void order_swept();
  void pair_moving(std::span<const BodyMotion> bodies, double h_s);
  void add(int shape_a, int shape_b, double reach_m);
  bool may_touch(int body_a, int body_b) const;
  double rotation_reach_m(const BodyMotion& m, int shape, double h_s) const;
  bool add_impacts(std::span<const BodyMotion> bodies, std::span<const int> active, double h_s);

  double tolerance_m_, gravity_m_s2_;
  std::vector<Extent> extents_;
  std::vector<Eigen::Isometry3d> in_body_, poses_;  // about the centre of mass of the body; in the world
  std::vector<int> body_of_;
  std::vector<double> restitution_;          // per shape
  std::vector<int> half_space_of_;           // per shape; -1: no half space
  std::vector<double> impact_speed_m_s_;     // per body: speed that impacts within the step may add
  std::vector<std::vector<int>> shapes_of_;  // per moving body
  std::vector<int> fixed_;                   // shapes in the grid, by their index in the grid
  BoundsGrid grid_;
  std::vector<HalfSpace> half_spaces_;
  std::vector<std::pair<int, int>> excluded_pairs_;  // sorted pairs of bodies that do not collide
  std::vector<Swept> swept_;
  std::vector<Span> order_;
  std::vector<int> grid_hits_;
  std::vector<NearPair> pairs_;
};

}  // namespace tactus::sim
