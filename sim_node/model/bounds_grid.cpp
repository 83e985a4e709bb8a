#include "sim_node/model/bounds_grid.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace tactus::sim {
namespace {

constexpr long long kMaxCells = 64;  // of one box or one query; beyond it a linear search costs no more
constexpr int kFurthest = (1 << 20) - 1;
constexpr double kSmallestCell_m = 1e-3;

template <class Visit>
void each_cell(const Eigen::Array3i& min, const Eigen::Array3i& max, Visit&& visit) {
  for (int x = min.x(); x <= max.x(); ++x)
    for (int y = min.y(); y <= max.y(); ++y)
      for (int z = min.z(); z <= max.z(); ++z) visit(x, y, z);
}

}  // namespace

// Primes of Teschner et al. 2003, "Optimized spatial hashing for collision detection of deformable objects", 4.1.
std::uint32_t BoundsGrid::bucket_of(int x, int y, int z) const {
  const auto part = [](int v, std::uint32_t prime) { return static_cast<std::uint32_t>(v) * prime; };
  return (part(x, 73856093) ^ part(y, 19349663) ^ part(z, 83492791)) & (buckets_ - 1);
}

BoundsGrid::Range BoundsGrid::range_of(const Bounds& b) const {
  const auto cell = [&](const Eigen::Vector3d& p) -> Eigen::Array3i {
    return (p / cell_m_).array().floor().max(-kFurthest).min(kFurthest).cast<int>();
  };
  return {cell(b.min_m), cell(b.max_m)};
}

void BoundsGrid::build(std::span<const Bounds> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  sizes_.clear();
  for (const Bounds& b : boxes_) sizes_.push_back((b.max_m - b.min_m).maxCoeff());
  entries_.clear();
  large_.clear();
  buckets_ = std::bit_ceil(static_cast<std::uint32_t>(2 * boxes_.size() + 1));
  if (boxes_.empty()) return;
  const auto middle = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
  std::nth_element(sizes_.begin(), middle, sizes_.end());
  // design: most boxes span one or two cells, and a query visits few others
  cell_m_ = std::max(4 * *middle, kSmallestCell_m);
  for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) {
    const Range r = range_of(boxes_[static_cast<std::size_t>(i)]);
    if (r.cells() > kMaxCells)
      large_.push_back(i);
    else
      each_cell(r.min, r.max, [&](int x, int y, int z) { entries_.push_back({bucket_of(x, y, z), i}); });
  }
  // Counting sort, filled from the end so that each bucket is in order.
  first_.assign(buckets_ + 1, 0);
  for (const Entry& e : entries_) ++first_[e.bucket];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  in_.resize(entries_.size());
  for (auto e = entries_.rbegin(); e != entries_.rend(); ++e)
    in_[static_cast<std::size_t>(--first_[e->bucket])] = e->box;
}

void BoundsGrid::find(const Bounds& query, std::vector<int>& found) const {
  const auto begin = static_cast<std::ptrdiff_t>(found.size());
  const auto add_if_overlapping = [&](int box) {
    if (boxes_[static_cast<std::size_t>(box)].overlaps(query)) found.push_back(box);
  };
  if (boxes_.empty()) return;
  const Range r = range_of(query);
  if (r.cells() > kMaxCells) {
    for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) add_if_overlapping(i);
    return;
  }
  for (const int box : large_) add_if_overlapping(box);
  each_cell(r.min, r.max, [&](int x, int y, int z) {
    const std::uint32_t bucket = bucket_of(x, y, z);
    for (int k = first_[bucket]; k < first_[bucket + 1]; ++k) add_if_overlapping(in_[static_cast<std::size_t>(k)]);
  });
  std::sort(found.begin() + begin, found.end());
  found.erase(std::unique(found.begin() + begin, found.end()), found.end());
}

}  // namespace tactus::sim
