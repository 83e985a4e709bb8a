// Contacts of two meshes, nearest first and one at a time: for who needs the nearest of each place and direction
// only, as a tool does, which is far less than all of them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim_node/collision/gaps/facing_pairs.h"
#include "sim_node/collision/layers/mesh_contact.h"
#include "sim_node/collision/nearest_first.h"
#include "sim_node/collision/triangle_tree.h"

namespace tactus::sim::gaps {

class MeshNearest {
 public:
  struct Mesh {
    const TriangleTree& tree;
    const ContactMesh& layers;
    const NormalCones& cones;
    const Eigen::Isometry3d& pose;
  };
  explicit MeshNearest(Isa isa) : facing_(isa) {}
  // The same contacts as all pairs of the three layers of which is_contact() says yes, to within rounding, but it
  // is asked only of those that `to` does not know by then. `room` is used. Deterministic. Realtime-safe once the
  // lists have grown.
  void find(const Mesh& a, const Mesh& b, double reach_m, NearestFirst& to, std::vector<PointPair>& room);

 private:
  FacingPairs facing_;
  Duplicates layer3_;
  std::vector<std::pair<int, int>> leaves_;
  struct Turn {
    double gap_m;
    std::uint32_t pair;
    bool parted;
  };
  std::vector<Turn> turns_;
};

// What complete_contact() finds, without the types; a pair that leads from where one of these two triangles is
// nearer itself, which is none of a contact, has an infinite gap. Nothing when the two cannot hold a contact by
// how far ways to what is nearest may lean (NormalCones). Both in one frame. Appends.
void marked_pairs(const Triangle& a, double lean_a, const Triangle& b, double lean_b, double tolerance_m,
                  std::vector<PointPair>& out);

}  // namespace tactus::sim::gaps
