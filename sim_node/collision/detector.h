// Finds where shapes touch: one interface for every way of doing it. A detector says what it can provide, and what
// it cannot do it refuses with a sentence before anything starts.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_node/collision/layers/mesh_contact.h"
#include "sim_node/model/point_pair.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

class MeshTrees;

struct DetectorAbilities {
  std::string_view name;
  // Point pairs of surfaces that are apart, up to the reach of the query; else only where they overlap.
  bool separation = false;
  // Each point lies on its surface; else both are about a place between, half the gap to either side.
  bool both_surfaces = false;
  bool overlap_depth = true;   // negative gaps where shapes overlap; else 0 there, marked as pierced
  bool least_depth = true;   // depth is the shortest way out; else a way out near it, never shorter
  bool contact_kind = false;   // PointPair::kind is found out; else always kPoint
  bool one_pair = false;       // never more than the deepest pair
  bool deterministic = false;  // the same query gives the same pairs to the bit, whatever was asked before
};

class Detector {
 public:
  virtual ~Detector() = default;
  virtual DetectorAbilities abilities() const = 0;

  // Empty when such a pair can be queried; else one sentence with what to choose instead.
  std::string refusal(ShapeKind a, ShapeKind b) const;
  // Makes a shape ready and returns its number, from 0 on. Throws std::runtime_error with one sentence when this
  // detector cannot take it. world: for its meshes and heightfields.
  virtual int add(const ShapeDef& shape, const WorldDef& world) = 0;
  // Pairs of two shapes whose gap is at most `reach_m`, into `out`, cleared first; poses of the shapes in the
  // world. A detector without separation() finds what overlaps. Realtime-safe as far as the library behind it is.
  // Not for two threads at once.
  virtual void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b,
                     double reach_m, std::vector<PointPair>& out) = 0;

 protected:
  virtual bool takes(ShapeKind a, ShapeKind b) const = 0;
};

// ode: dCollide of ODE. ccd, ccd_mpr: libccd, convex shapes, by GJK and EPA or by MPR. fcl: where it was built in.
// layers: ours, for meshes, boxes and heightfields as triangles. gaps: ours, for every pair; meshes by the layers.
// auto: gaps.
std::span<const std::string_view> detector_names();
// Throws std::runtime_error with one sentence when the name is unknown or that detector was not built in. trees: of
// the world whose shapes will be added, where others use them too.
std::unique_ptr<Detector> make_detector(std::string_view name, const MeshContactOptions& layers = {},
                                        std::shared_ptr<MeshTrees> trees = nullptr);

std::unique_ptr<Detector> make_ode_detector();
std::unique_ptr<Detector> make_ccd_detector(bool mpr);
std::unique_ptr<Detector> make_fcl_detector();  // null: not built in
std::unique_ptr<Detector> make_layers_detector(const MeshContactOptions& options,
                                               std::shared_ptr<MeshTrees> trees = nullptr);
std::unique_ptr<Detector> make_gaps_detector(const MeshContactOptions& options,
                                             std::shared_ptr<MeshTrees> trees = nullptr);

}  // namespace tactus::sim
