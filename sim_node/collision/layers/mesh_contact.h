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

// A mesh, prepared for queries.
struct ContactMesh {
  ContactMesh() = default;
  // Throws std::runtime_error with one sentence when an index or a vertex is invalid.
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
  std::vector<PointPair> pairs;  // world frame; gaps are >= 0; of triangles, not of the meshes as a whole
  bool pierced = false;          // an edge of one mesh passes through a face of the other: the meshes overlap there
  std::size_t leaf_pairs = 0, raw_pairs = 0;  // after layer 1, after layer 2
};

class MeshContact {
 public:
  explicit MeshContact(const MeshContactOptions& options = {});
  // Throws std::runtime_error with one sentence when the options do not support these meshes: the adjacency remover
  // needs well-constructed ones. Call it at start-up.
  void check_supported(const ContactMesh& a, const ContactMesh& b) const;
  // Writes all point pairs within the tolerance into `out`, after clearing it. Deterministic, and bit-identical with
  // every instruction set. Real-time safe once the lists have grown. Not thread-safe.
  void query(const ContactMesh& a, const Eigen::Isometry3d& pose_a, const ContactMesh& b,
             const Eigen::Isometry3d& pose_b, const Reach& reach, MeshContactResult& out);

 private:
  MeshContactOptions options_;
  LeafPairs layer1_;
  Duplicates layer3_;
  std::vector<std::pair<int, int>> leaves_;
};

}  // namespace tactus::sim
