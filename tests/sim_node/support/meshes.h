// Generated meshes for tests and measurements of collision: lumpy spheres, combs, plates, and difficult polygon
// soups.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace tactus::sim::test {

struct Soup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<int> indices;

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    for (const Eigen::Vector3d& v : {a, b, c}) {
      indices.push_back(static_cast<int>(vertices.size()));
      vertices.push_back(v);
    }
  }
  void add(const Soup& other, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
    const int first = static_cast<int>(vertices.size());
    for (const Eigen::Vector3d& v : other.vertices) vertices.push_back(pose * v);
    for (const int i : other.indices) indices.push_back(first + i);
  }
  int triangles() const { return static_cast<int>(indices.size() / 3); }
  const Eigen::Vector3d& corner(int triangle, int k) const {
    return vertices[static_cast<std::size_t>(indices[static_cast<std::size_t>(3 * triangle + k)])];
  }
};

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  // Not the standard library's distribution, which differs between implementations.
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

inline Eigen::Vector3d direction(Random& random) {
  for (;;) {
    const Eigen::Vector3d v(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}

inline Eigen::Isometry3d random_pose(Random& random, double reach) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(reach * uniform(random, 0, 1) * direction(random));
  pose.rotate(Eigen::AngleAxisd(uniform(random, 0, 2 * M_PI), direction(random)));
  return pose;
}

// 20 * 4^level triangles, closed.
inline Soup icosphere(int level, double radius) {
  Soup s;
  const double g = (1 + std::sqrt(5.0)) / 2;
  s.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
               3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<int, int>, int> middle;
    const auto between = [&](int i, int j) {
      const auto [at, is_new] =
          middle.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(s.vertices.size()));
      if (is_new)
        s.vertices.push_back(s.vertices[static_cast<std::size_t>(i)].normalized() +
                             s.vertices[static_cast<std::size_t>(j)].normalized());
      return at->second;
    };
    std::vector<int> finer;
    for (std::size_t t = 0; t < s.indices.size(); t += 3) {
      const int a = s.indices[t], b = s.indices[t + 1], c = s.indices[t + 2];
      const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
      for (const int i : {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca}) finer.push_back(i);
    }
    s.indices = finer;
  }
  for (Eigen::Vector3d& v : s.vertices) v = radius * v.normalized();
  return s;
}

// With lumps and 1 % of fine noise: no two triangles are equal.
inline Soup lumpy_sphere(int level, double radius, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::pair<Eigen::Vector3d, double>> waves;
  for (int i = 0; i < 6; ++i)
    waves.emplace_back(uniform(random, 1, 5) * direction(random), uniform(random, 0, 2 * M_PI));
  Soup s = icosphere(level, 1);
  for (Eigen::Vector3d& v : s.vertices) {
    double r = 1;
    for (const auto& [wave, phase] : waves) r += 0.05 * std::sin(wave.dot(v) + phase);
    v *= radius * (r + 0.01 * uniform(random, -1, 1));
  }
  return s;
}

// A rectangle in the plane z = 0 about the origin, n by m squares.
inline Soup plate(double width, double depth, int n, int m) {
  Soup s;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j)
      s.vertices.emplace_back(width * (double(i) / n - 0.5), depth * (double(j) / m - 0.5), 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * (m + 1) + j, b = a + m + 1;
      for (const int k : {a, b, b + 1, a, b + 1, a + 1}) s.indices.push_back(k);
    }
  return s;
}

inline Soup box(const Eigen::Vector3d& size) {
  Soup s;
  for (int i = 0; i < 8; ++i)
    s.vertices.emplace_back((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                            (i & 4 ? 0.5 : -0.5) * size.z());
  s.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return s;
}

// A bar with teeth: concave, with many parallel faces.
inline Soup comb(int teeth, double length) {
  Soup s = box({length, 0.2 * length, 0.1 * length});
  const double pitch = length / teeth;
  for (int i = 0; i < teeth; ++i)
    s.add(box({0.4 * pitch, 0.2 * length, 0.4 * length}),
          Eigen::Isometry3d(Eigen::Translation3d((i + 0.5) * pitch - length / 2, 0, 0.25 * length)));
  return s;
}

// Needles up to ten thousand times longer than wide.
inline Soup slivers(int count, double length, std::uint64_t seed) {
  Random random(seed);
  Soup s;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d at = length * uniform(random, 0, 1) * direction(random),
                          along = length * direction(random);
    const double width = length * std::pow(10.0, -uniform(random, 1, 4));
    s.add(at, at + along, at + 0.5 * along + width * direction(random));
  }
  return s;
}

// Every third triangle duplicated, every fourth reversed.
inline Soup doubled_and_reversed(const Soup& from) {
  Soup s;
  for (int i = 0; i < from.triangles(); ++i) {
    const bool reversed = i % 4 == 0;
    for (int copies = i % 3 == 0 ? 2 : 1; copies > 0; --copies)
      s.add(from.corner(i, 0), from.corner(i, reversed ? 2 : 1), from.corner(i, reversed ? 1 : 2));
  }
  return s;
}

// Some triangles shrunk to a point or a line, beside the complete ones.
inline Soup with_degenerate(const Soup& from) {
  Soup s = from;
  for (int i = 0; i < from.triangles(); i += 5) {
    const Eigen::Vector3d a = from.corner(i, 0), b = from.corner(i, 1);
    s.add(a, a, a);
    s.add(a, b, b);
    s.add(a, b, a + 0.25 * (b - a));
  }
  return s;
}

// A plate whose two halves are divided differently, so that vertices of one lie on edges of the other.
inline Soup t_junctions(double width) {
  Soup s;
  s.add(plate(width / 2, width, 2, 3), Eigen::Isometry3d(Eigen::Translation3d(-width / 4, 0, 0)));
  s.add(plate(width / 2, width, 3, 7), Eigen::Isometry3d(Eigen::Translation3d(width / 4, 0, 0)));
  return s;
}

}  // namespace tactus::sim::test
