#include "sim_node/collision/layers/duplicates.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::sim {
namespace {

// Cell size of the hash grid. Much larger than kSamePosition_m, so that nearly every pair searches its own cell
// only. Much smaller than a manifold, so that few pairs share a cell.
constexpr double kCell_m = 128 * kSamePosition_m;

std::size_t hash(std::int64_t x, std::int64_t y, std::int64_t z) {
  // Teschner et al. 2003, Optimized spatial hashing, equation 1, with the upper bits folded in.
  const std::uint64_t h = static_cast<std::uint64_t>(x) * 73856093u ^ static_cast<std::uint64_t>(y) * 19349663u ^
                          static_cast<std::uint64_t>(z) * 83492791u;
  return static_cast<std::size_t>((h ^ h >> 17) * 0x9e3779b97f4a7c15u >> 20);
}

std::int64_t cell(double x) { return static_cast<std::int64_t>(std::floor(x / kCell_m)); }

}  // namespace

bool same_pair(const PointPair& x, const PointPair& y) {
  return (x.on_a_m - y.on_a_m).squaredNorm() <= kSamePosition_m * kSamePosition_m &&
         (x.on_b_m - y.on_b_m).squaredNorm() <= kSamePosition_m * kSamePosition_m;
}

void Duplicates::remove_hashed(std::vector<PointPair>& pairs) {
  if (pairs.size() < 2) return;
  const std::size_t size = std::bit_ceil(2 * pairs.size()), mask = size - 1;
  if (table_.size() < size) table_.resize(size);
  std::fill_n(table_.begin(), size, 0u);
  next_.resize(std::max(next_.size(), pairs.size()));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PointPair pair = pairs[i];
    bool is_new = true;
    std::int64_t low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      low[k] = cell(pair.on_a_m[k] - kSamePosition_m);
      high[k] = cell(pair.on_a_m[k] + kSamePosition_m);
    }
    for (std::int64_t x = low[0]; x <= high[0] && is_new; ++x)
      for (std::int64_t y = low[1]; y <= high[1] && is_new; ++y)
        for (std::int64_t z = low[2]; z <= high[2] && is_new; ++z)
          for (std::uint32_t at = table_[hash(x, y, z) & mask]; at && is_new; at = next_[at - 1])
            is_new = !same_pair(pairs[at - 1], pair);
    if (!is_new) continue;
    std::uint32_t& head = table_[hash(cell(pair.on_a_m.x()), cell(pair.on_a_m.y()), cell(pair.on_a_m.z())) & mask];
    next_[kept] = head;
    pairs[kept++] = pair;
    head = static_cast<std::uint32_t>(kept);
  }
  pairs.resize(kept);
}

void Duplicates::remove_brute_force(std::vector<PointPair>& pairs) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto end = pairs.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::none_of(pairs.begin(), end, [&](const PointPair& p) { return same_pair(p, pairs[i]); }))
      pairs[kept++] = pairs[i];
  }
  pairs.resize(kept);
}

void Duplicates::remove_adjacent(const MeshCheck& a, const MeshCheck& b, std::vector<PointPair>& pairs) {
  // Linked lists of the results of each triangle of a.
  const std::size_t triangles = a.first.size() - 1;
  if (table_.size() < triangles) table_.resize(triangles);
  std::fill_n(table_.begin(), triangles, 0u);
  next_.resize(std::max(next_.size(), pairs.size()));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PointPair pair = pairs[i];
    const auto near_b = b.around(pair.triangle_b);
    bool is_new = true;
    for (const int t : a.around(pair.triangle_a)) {
      for (std::uint32_t at = table_[static_cast<std::size_t>(t)]; at && is_new; at = next_[at - 1])
        is_new = !(same_pair(pairs[at - 1], pair) &&
                   std::binary_search(near_b.begin(), near_b.end(), pairs[at - 1].triangle_b));
      if (!is_new) break;
    }
    if (!is_new) continue;
    std::uint32_t& head = table_[static_cast<std::size_t>(pair.triangle_a)];
    next_[kept] = head;
    pairs[kept++] = pair;
    head = static_cast<std::uint32_t>(kept);
  }
  pairs.resize(kept);
}

}  // namespace tactus::sim
