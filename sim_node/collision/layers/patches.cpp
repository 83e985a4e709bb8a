#include "sim_node/collision/layers/patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tactus::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Depths that differ by less are equal, m: a tenth of the deepest overlap that bodies may have.
constexpr double kFlat_m = 1e-6;

Vector3d middle(const PointPair& p) { return (p.on_a_m + p.on_b_m) / 2; }

// Orders by depth, then by position, so that the order of the input does not matter.
bool before(const PointPair* x, const PointPair* y) {
  if (x->gap_m != y->gap_m) return x->gap_m < y->gap_m;
  for (int k = 0; k < 3; ++k)
    if (x->on_a_m[k] != y->on_a_m[k]) return x->on_a_m[k] < y->on_a_m[k];
  for (int k = 0; k < 3; ++k)
    if (x->on_b_m[k] != y->on_b_m[k]) return x->on_b_m[k] < y->on_b_m[k];
  return false;
}

double cross(const Vector2d& o, const Vector2d& a, const Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

// Convex hull by the monotone chain algorithm (Andrew 1979). Returns the area.
double hull_of(std::vector<Vector2d>& points, std::vector<Vector2d>& hull) {
  hull.clear();
  if (points.size() < 3) return 0;
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  const auto run = [&](const Vector2d& p, std::size_t min_size) {
    while (hull.size() >= min_size + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const Vector2d& p : points) run(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) run(points[i], lower);
  double area = 0;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i) area += cross(hull[0], hull[i], hull[i + 1]) / 2;
  return area;
}

// Extent along and across the longest direction.
std::pair<double, double> extent(const std::vector<Vector2d>& points) {
  double length = 0, low = 0, high = 0;
  Vector2d from = points.front(), to = from;
  for (const Vector2d& p : points)
    if ((p - points.front()).norm() > length) length = (p - points.front()).norm(), from = p;
  length = 0;
  for (const Vector2d& p : points)
    if ((p - from).norm() > length) length = (p - from).norm(), to = p;
  if (length == 0) return {0, 0};
  const Vector2d along = (to - from) / length;
  for (const Vector2d& p : points) {
    const double side = along.x() * (p - from).y() - along.y() * (p - from).x();
    low = std::min(low, side), high = std::max(high, side);
  }
  return {length, high - low};
}

}  // namespace

// Collects the pairs of the patch that begins with pair `first` in patch_, and their projections along its normal in
// flat_.
void Patches::gather(std::size_t first, const ContactPatch& patch, double alike) {
  patch_.clear();
  flat_.clear();
  const PointPair& deepest = *order_[first];
  const Vector3d x = patch.normal.unitOrthogonal(), y = patch.normal.cross(x);
  box_.setEmpty();
  for (std::size_t i = first; i < order_.size(); ++i) {
    if (taken_[i] || order_[i]->normal.dot(patch.normal) < alike) continue;
    taken_[i] = true;
    patch_.push_back(order_[i]);
    const Vector3d p = middle(*order_[i]) - middle(deepest);
    flat_.emplace_back(p.dot(x), p.dot(y));
    box_.extend(flat_.back());
  }
}

// Around a patch there are oblique pairs, which connect a point to a position that is not opposite. They are dropped
// where their gap along the patch's normal is not smaller than at the deepest pair.
void Patches::drop_oblique(std::size_t first, const ContactPatch& patch, double tolerance_m) {
  const PointPair& deepest = *order_[first];
  const Vector3d x = patch.normal.unitOrthogonal(), y = patch.normal.cross(x);
  for (std::size_t i = first; i < order_.size(); ++i) {
    if (taken_[i] || order_[i]->gap_m * order_[i]->normal.dot(patch.normal) < deepest.gap_m - kFlat_m) continue;
    const Vector3d p = middle(*order_[i]) - middle(deepest);
    taken_[i] = box_.squaredExteriorDistance(Vector2d(p.dot(x), p.dot(y))) <= tolerance_m * tolerance_m;
  }
}

// Selects the deepest pair, the furthest from it, and the furthest on either side of the line between them.
void Patches::choose(double tolerance_m, ContactPatch& patch) const {
  const auto [length, width] = extent(flat_);
  patch.kind = length < tolerance_m  ? ContactKind::kPoint
               : width < tolerance_m ? ContactKind::kEdge
                                     : ContactKind::kSurface;
  const auto add = [&](std::size_t i) { patch.points[static_cast<std::size_t>(patch.count++)] = *patch_[i]; };
  const auto best = [&](auto&& score) {
    std::size_t at = 0;
    double max_score = 0;
    for (std::size_t i = 0; i < flat_.size(); ++i)
      if (score(i) > max_score) max_score = score(i), at = i;
    return std::pair(at, max_score);
  };
  // Among equally deep pairs, as of parallel faces, a corner is selected.
  Vector2d centre(0, 0);
  for (const Vector2d& p : flat_) centre += p / static_cast<double>(flat_.size());
  const double deep = patch_.front()->gap_m + kFlat_m;
  const std::size_t from =
      patch.kind == ContactKind::kPoint
          ? 0
          : best([&](std::size_t i) { return patch_[i]->gap_m <= deep ? (flat_[i] - centre).norm() : 0.0; }).first;
  add(from);
  if (patch.kind == ContactKind::kPoint) return;
  const std::size_t to = best([&](std::size_t i) { return (flat_[i] - flat_[from]).norm(); }).first;
  add(to);
  if (patch.kind == ContactKind::kEdge) return;
  const double base = (flat_[to] - flat_[from]).norm();
  for (const double side : {1.0, -1.0}) {
    const auto [at, area] = best([&](std::size_t i) { return side * cross(flat_[from], flat_[to], flat_[i]); });
    if (area > tolerance_m * base / 2) add(at);
  }
}

void Patches::make(std::span<const PointPair> pairs, double tolerance_m, std::vector<ContactPatch>& out,
                   double angle_rad) {
  out.clear();
  order_.clear();
  for (const PointPair& p : pairs) order_.push_back(&p);
  std::sort(order_.begin(), order_.end(), before);
  taken_.assign(order_.size(), false);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (taken_[i]) continue;
    ContactPatch& patch = out.emplace_back();
    patch.normal = order_[i]->normal;
    gather(i, patch, std::cos(angle_rad));
    drop_oblique(i, patch, tolerance_m);
    choose(tolerance_m, patch);
    patch.area_m2 = hull_of(flat_, hull_);
  }
}

}  // namespace tactus::sim
