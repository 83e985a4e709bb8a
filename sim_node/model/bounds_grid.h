// Hashed uniform grid for overlap queries of boxes. Boxes that span many cells are tested in every query. Pure,
// deterministic.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/model/swept_sphere.h"

namespace tactus::sim {

class BoundsGrid {
 public:
  // Rebuilds the index. Real-time safe once its lists have grown.
  void build(std::span<const Bounds> boxes);
  // Appends the boxes that overlap the query to `found`, in ascending order, each once.
  void find(const Bounds& query, std::vector<int>& found) const;

 private:
  struct Entry {  // one box in one cell
    std::uint32_t bucket;
    int box;
  };
  struct Range {
    Eigen::Array3i min, max;
    long long cells() const { return (max - min + 1).cast<long long>().prod(); }
  };
  Range range_of(const Bounds& b) const;
  std::uint32_t bucket_of(int x, int y, int z) const;

  double cell_m_ = 1;
  std::vector<Bounds> boxes_;
  std::vector<Entry> entries_;
  std::uint32_t buckets_ = 1;    // a power of two
  std::vector<int> first_, in_;  // the boxes of each bucket: in_[first_[bucket]...]
  std::vector<int> large_;       // boxes that span too many cells
  std::vector<double> sizes_;
};

}  // namespace tactus::sim
