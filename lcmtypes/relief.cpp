#include "lcmtypes/relief.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus {
namespace {

constexpr double kSteepest = 100;

float slope_of(double rise) { return static_cast<float>(std::clamp(rise, -kSteepest, kSteepest)); }

int wrapped(int i, int n) { return ((i % n) + n) % n; }

// The pixel whose centre is at or before a place, in repetitions, and the share of the way to the next.
int pixel(double at, int n, double& share) {
  const double x = (at - std::floor(at)) * n - 0.5, whole = std::floor(x);
  share = x - whole;
  return wrapped(static_cast<int>(whole), n);
}

// Weights of four neighbours, from the one before the left: the spline of second order whose control points are the
// means of neighbours. Its derivative changes linearly from the central difference at the left to that at the
// right.
std::array<double, 4> spline(double f) {
  const double before = (1 - f) * (1 - f) / 4, middle = (1 + 2 * f - 2 * f * f) / 4, after = f * f / 4;
  return {before, before + middle, middle + after, after};
}

}  // namespace

Texel texel_at(const Eigen::Vector2d& at, int columns, int rows) {
  Texel t{};
  t.left = pixel(at.x(), columns, t.along_u);
  t.below = pixel(at.y(), rows, t.along_v);
  t.right = t.left + 1 < columns ? t.left + 1 : 0;
  t.above = t.below + 1 < rows ? t.below + 1 : 0;
  return t;
}

Eigen::Vector2d Relief::slope(const Eigen::Vector2d& at) const {
  const Texel t = texel_at(at, columns, rows);
  const auto value = [&](int column, int row) {
    return Eigen::Vector2d(slopes[static_cast<std::size_t>(row * columns + column)].cast<double>());
  };
  const Eigen::Vector2d below = value(t.left, t.below) * (1 - t.along_u) + value(t.right, t.below) * t.along_u;
  const Eigen::Vector2d above = value(t.left, t.above) * (1 - t.along_u) + value(t.right, t.above) * t.along_u;
  return below * (1 - t.along_v) + above * t.along_v;
}

double Relief::height_m(const Eigen::Vector2d& at) const {
  const Texel t = texel_at(at, columns, rows);
  const std::array<double, 4> u = spline(t.along_u), v = spline(t.along_v);
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    const int row = wrapped(t.below + j - 1, rows);
    for (int i = 0; i < 4; ++i)
      sum += v[static_cast<std::size_t>(j)] * u[static_cast<std::size_t>(i)] *
             static_cast<double>(
                 heights_m[static_cast<std::size_t>(row * columns + wrapped(t.left + i - 1, columns))]);
  }
  return sum;
}

Relief make_relief(const HeightMap& map, const material_def_t& material) {
  Relief relief;
  relief.size_m = Eigen::Vector2d(material.bump_size_u_m, material.bump_size_v_m).cast<float>();
  relief.columns = map.columns, relief.rows = map.rows;
  relief.slopes.reserve(map.levels.size());
  relief.heights_m.reserve(map.levels.size());
  // Height over the distance of the two neighbours.
  const double along_u = material.bump_height_m * map.columns / (2 * material.bump_size_u_m);
  const double along_v = material.bump_height_m * map.rows / (2 * material.bump_size_v_m);
  for (int row = 0; row < map.rows; ++row) {
    const int above = (row + 1) % map.rows, below = (row + map.rows - 1) % map.rows;
    for (int column = 0; column < map.columns; ++column) {
      const int right = (column + 1) % map.columns, left = (column + map.columns - 1) % map.columns;
      relief.heights_m.push_back(static_cast<float>(material.bump_height_m * map.at(column, row)));
      relief.slopes.emplace_back(slope_of(along_u * (map.at(right, row) - map.at(left, row))),
                                 slope_of(along_v * (map.at(column, above) - map.at(column, below))));
    }
  }
  return relief;
}

Eigen::Vector3d relief_normal(const Eigen::Vector3d& normal_body, const Eigen::Vector2d& slope) {
  const BumpAxes axes = bump_axes(normal_body);
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  gradient[axes.u] = slope.x(), gradient[axes.v] = slope.y();
  gradient -= gradient.dot(normal_body) * normal_body;
  return (normal_body - gradient).normalized();
}

}  // namespace tactus
