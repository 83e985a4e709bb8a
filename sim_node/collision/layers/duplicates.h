// Layer 3: no point pair twice. Each of them becomes a force, so a duplicate would double it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/collision/layers/mesh_check.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim {

// Two pairs are one when both their points are nearer to each other than this, m: a thousand times what rounding
// makes of a place 100 m away, and a thousandth of what a contact can resolve.
inline constexpr double kSamePlace_m = 1e-7;

bool same_pair(const PointPair& x, const PointPair& y);

enum class DuplicateRemover {
  kHashed,      // by quantised place, looking into the neighbouring cells too: O(n)
  kBruteForce,  // I-Touch's first: O(n^2)
  kAdjacency    // I-Touch's second: among neighbouring triangles only, so only for well constructed meshes
};

// All keep the first of several, in the order given. Realtime-safe once its lists have grown.
class Duplicates {
 public:
  void remove_hashed(std::vector<PointPair>& pairs);
  static void remove_brute_force(std::vector<PointPair>& pairs);
  // Both meshes must be well constructed.
  void remove_adjacent(const MeshCheck& a, const MeshCheck& b, std::vector<PointPair>& pairs);

 private:
  std::vector<std::uint32_t> table_;  // of the first pair of a chain, plus one
  std::vector<std::uint32_t> next_;
};

}  // namespace tactus::sim
