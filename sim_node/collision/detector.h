// Interface of all collision detectors. A detector states its abilities, and rejects unsupported shapes at start-up
// with one sentence.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
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
  // Reports point pairs of separated surfaces up to the reach of the query. Without it, reports overlaps only.
  bool separation = false;
  // Each point lies on its own surface. Without it, both points lie half the gap to either side of one contact
  // position.
  bool both_surfaces = false;
  bool overlap_depth = true;   // gaps are negative in overlap; without it they are 0 and marked as pierced
  bool minimum_translation = true;  // depth is the minimum translation distance; without it, depth may be larger
  bool contact_kind = false;   // sets PointPair::kind; without it, kind is always kPoint
  bool one_pair = false;       // reports at most the deepest pair
  bool deterministic = false;  // equal queries give bit-identical pairs, independent of earlier queries
};

class Detector {
 public:
  virtual ~Detector() = default;
  virtual DetectorAbilities abilities() const = 0;

  // Returns an empty string when this pair is supported, else one sentence that names an alternative.
  std::string unsupported_reason(ShapeKind a, ShapeKind b) const;
  // Prepares a shape and returns its index, counted from 0. Throws std::runtime_error with one sentence when this
  // detector does not support the shape. world: source of meshes and heightfields.
  virtual int add(const ShapeDef& shape, const WorldDef& world) = 0;
  // Writes the pairs of two shapes with a gap of at most `reach_m` into `out`, after clearing it. Poses map the
  // frames of the shapes to the world. A detector without separation() reports overlaps only. Real-time safe as far
  // as the library behind it is. Not thread-safe.
  virtual void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b,
                     double reach_m, std::vector<PointPair>& out) = 0;

 protected:
  virtual bool supports(ShapeKind a, ShapeKind b) const = 0;
};

// Makes a detector of another program available as the setting detector = custom:NAME. Call it before run() and from one thread. Throws
// std::invalid_argument when the name is empty or already registered.
void register_detector(std::string name, std::function<std::unique_ptr<Detector>()> make);

// ode: dCollide of ODE. ccd, ccd_mpr: libccd for convex shapes, by GJK and EPA or by MPR. fcl: FCL, where it was
// built in. layers: own detector for meshes, boxes and heightfields as triangles. gaps: own detector for every pair;
// it uses the layers for meshes. auto: gaps. custom:NAME: a registered one.
// Throws std::runtime_error with one sentence when the name is unknown or the detector was not built in. trees:
// shared trees of the world whose shapes will be added; null: the detector makes its own.
std::unique_ptr<Detector> make_detector(std::string_view name, const MeshContactOptions& layers = {},
                                        std::shared_ptr<MeshTrees> trees = nullptr);

std::unique_ptr<Detector> make_ode_detector();
std::unique_ptr<Detector> make_ccd_detector(bool mpr);
std::unique_ptr<Detector> make_fcl_detector();  // null when FCL was not built in
std::unique_ptr<Detector> make_layers_detector(const MeshContactOptions& options,
                                               std::shared_ptr<MeshTrees> trees = nullptr);
std::unique_ptr<Detector> make_gaps_detector(const MeshContactOptions& options,
                                             std::shared_ptr<MeshTrees> trees = nullptr);

}  // namespace tactus::sim
