// Finds the boxes that may meet a given one among many: cells of one size; what is larger than a few cells is
// looked at each time. Pure, deterministic.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/dual/swept_sphere.h"

namespace tactus::sim {

class BoundsGrid {
 public:
  // Indexes these boxes anew. Realtime-safe once its lists have grown.
  void build(std::span<const Bounds> boxes);
  // Appends those that meet the query to `found`, in ascending order, each once.
  void find(const Bounds& query, std::vector<int>& found) const;

 private:
  struct Cell {
    std::uint64_t key;
    int box;
    bool operator<(const Cell& o) const { return key != o.key ? key < o.key : box < o.box; }
  };
  struct Range {
    Eigen::Array3i least, most;
    long long cells() const { return (most - least + 1).cast<long long>().prod(); }
  };
  Range range_of(const Bounds& b) const;

  double cell_m_ = 1;
  std::vector<Bounds> boxes_;
  std::vector<Cell> cells_;  // sorted
  std::vector<int> large_;   // in many cells
  std::vector<double> sizes_;
};

}  // namespace tactus::sim
