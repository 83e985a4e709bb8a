// Mesh against mesh by the three layers of I-Touch (I-Touch D6.8 2005, section 1.6): boxes, triangle pairs,
// duplicates.
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "sim_node/collision/layers/duplicates.h"
#include "sim_node/collision/layers/isa.h"
#include "sim_node/collision/layers/leaf_pairs.h"
#include "sim_node/collision/layers/triangle_pair.h"

namespace tactus::sim {

enum class ContactMode { kComplete, kItouch2005 };

// A mesh, ready for queries.
struct ContactMesh {
  ContactMesh() = default;
  // Throws std::runtime_error with one sentence when an index or a vertex makes no sense.
  ContactMesh(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices);
  ObbTree tree;
  MeshCheck check;
};

struct MeshContactOptions {
  ContactMode mode = ContactMode::kComplete;
  DuplicateRemover remover = DuplicateRemover::kHashed;
  Isa isa = best_isa();
};

struct MeshContactResult {
  std::vector<PointPair> pairs;  // world; gaps are >= 0; of triangles, not of the meshes as a whole
  bool pierced = false;          // an edge of one goes through a face of the other: they overlap there
  std::size_t leaf_pairs = 0, raw_pairs = 0;  // after layer 1, after layer 2
};

class MeshContact {
 public:
  explicit MeshContact(const MeshContactOptions& options = {});
  // Throws std::runtime_error with one sentence when these meshes cannot be queried as the options want it: the
  // adjacency remover needs well constructed ones. Ask before anything starts.
  void accept(const ContactMesh& a, const ContactMesh& b) const;
  // All point pairs within the tolerance, into `out`, cleared first. Deterministic, and the same to the bit with
  // every instruction set. Realtime-safe once the lists have grown. Not for two threads at once.
  void query(const ContactMesh& a, const Eigen::Isometry3d& pose_a, const ContactMesh& b,
             const Eigen::Isometry3d& pose_b, const Reach& reach, MeshContactResult& out);
  // Least distance between the meshes, m; 0 where they overlap; `beyond_m` when it is more than that: the smaller
  // that is, the faster.
  double distance_m(const ContactMesh& a, const Eigen::Isometry3d& pose_a, const ContactMesh& b,
                    const Eigen::Isometry3d& pose_b, double beyond_m);
  // The same with where it is, world; false when there is nothing within `beyond_m`. Costs as much as a few
  // contacts do, whatever `beyond_m` is, while a query() with a wide tolerance lists all that is within.
  bool nearest(const ContactMesh& a, const Eigen::Isometry3d& pose_a, const ContactMesh& b,
               const Eigen::Isometry3d& pose_b, double beyond_m, PointPair& out);

 private:
  MeshContactOptions options_;
  LeafPairs layer1_;
  Duplicates layer3_;
  std::vector<std::pair<int, int>> leaves_;
  std::vector<PointPair> search_;
};

}  // namespace tactus::sim
