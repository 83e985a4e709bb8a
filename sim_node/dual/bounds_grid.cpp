#include "sim_node/dual/bounds_grid.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {
namespace {

constexpr long long kMostCells = 64;  // of one box, or of one query: beyond that a look at all is as cheap
constexpr int kFurthest = (1 << 20) - 1;
constexpr double kSmallestCell_m = 1e-3;

// 21 bits for each axis.
std::uint64_t key_of(int x, int y, int z) {
  const auto part = [](int v) { return static_cast<std::uint64_t>(v + kFurthest + 1) & 0x1fffffu; };
  return part(x) << 42 | part(y) << 21 | part(z);
}

template <class Visit>
void each_cell(const Eigen::Array3i& least, const Eigen::Array3i& most, Visit&& visit) {
  for (int x = least.x(); x <= most.x(); ++x)
    for (int y = least.y(); y <= most.y(); ++y)
      for (int z = least.z(); z <= most.z(); ++z) visit(key_of(x, y, z));
}

}  // namespace

BoundsGrid::Range BoundsGrid::range_of(const Bounds& b) const {
  const auto cell = [&](const Eigen::Vector3d& p) -> Eigen::Array3i {
    return (p / cell_m_).array().floor().max(-kFurthest).min(kFurthest).cast<int>();
  };
  return {cell(b.least_m), cell(b.most_m)};
}

void BoundsGrid::build(std::span<const Bounds> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  sizes_.clear();
  for (const Bounds& b : boxes_) sizes_.push_back((b.most_m - b.least_m).maxCoeff());
  cells_.clear();
  large_.clear();
  if (boxes_.empty()) return;
  const auto middle = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
  std::nth_element(sizes_.begin(), middle, sizes_.end());
  // design: most boxes lie in one or two cells, a query sees few besides
  cell_m_ = std::max(4 * *middle, kSmallestCell_m);
  for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) {
    const Range r = range_of(boxes_[static_cast<std::size_t>(i)]);
    if (r.cells() > kMostCells)
      large_.push_back(i);
    else
      each_cell(r.least, r.most, [&](std::uint64_t key) { cells_.push_back({key, i}); });
  }
  std::sort(cells_.begin(), cells_.end());
}

void BoundsGrid::find(const Bounds& query, std::vector<int>& found) const {
  const auto begin = static_cast<std::ptrdiff_t>(found.size());
  const auto look = [&](int box) {
    if (boxes_[static_cast<std::size_t>(box)].meets(query)) found.push_back(box);
  };
  const Range r = range_of(query);
  if (r.cells() > kMostCells) {
    for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) look(i);
    return;
  }
  for (const int box : large_) look(box);
  each_cell(r.least, r.most, [&](std::uint64_t key) {
    for (auto it = std::lower_bound(cells_.begin(), cells_.end(), Cell{key, 0});
         it != cells_.end() && it->key == key; ++it)
      look(it->box);
  });
  std::sort(found.begin() + begin, found.end());
  found.erase(std::unique(found.begin() + begin, found.end()), found.end());
}

}  // namespace tactus::sim
