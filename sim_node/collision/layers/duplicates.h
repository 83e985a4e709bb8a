// Layer 3: removes duplicate point pairs. Each pair becomes a force, so a duplicate would double it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/collision/layers/mesh_check.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim {

// Two pairs are equal when both their points are nearer to each other than this, m: a thousand times the rounding at
// a distance of 100 m, and a thousandth of the resolution of a contact.
inline constexpr double kSamePosition_m = 1e-7;

bool same_pair(const PointPair& x, const PointPair& y);

enum class DuplicateRemover {
  kHashed,      // by quantised position, neighbouring cells included: O(n)
  kBruteForce,  // I-Touch's first algorithm: O(n^2)
  kAdjacency    // I-Touch's second algorithm: among neighbouring triangles only, so only for well-constructed meshes
};

// All functions keep the first of equal pairs, in the given order. Real-time safe once the lists have grown.
class Duplicates {
 public:
  void remove_hashed(std::vector<PointPair>& pairs);
  static void remove_brute_force(std::vector<PointPair>& pairs);
  // Both meshes must be well-constructed.
  void remove_adjacent(const MeshCheck& a, const MeshCheck& b, std::vector<PointPair>& pairs);

 private:
  std::vector<std::uint32_t> table_;  // of the first pair of a list, plus one; 0: empty
  std::vector<std::uint32_t> next_;
};

}  // namespace tactus::sim
