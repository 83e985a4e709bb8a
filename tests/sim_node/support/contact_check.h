// Compares the contact of two soups with the oracle.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "sim_node/collision/layers/mesh_contact.h"
#include "tests/sim_node/support/least_gap.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/triangle_oracle.h"

namespace tactus::sim::test {

// Position error of a pair that has been replaced by its duplicate, at most this, m.
inline constexpr double kAfterMerge_m = 2 * kSamePosition_m;

struct Placed {
  Placed(const Soup& soup, const Eigen::Isometry3d& pose) {
    for (int i = 0; i < soup.triangles(); ++i) {
      triangles.push_back({pose * soup.corner(i, 0), pose * soup.corner(i, 1), pose * soup.corner(i, 2)});
      Eigen::AlignedBox3d& box = boxes.emplace_back();
      for (const Eigen::Vector3d& v : triangles.back()) box.extend(v);
    }
  }
  bool near(std::size_t i, const Eigen::Vector3d& p, double within) const {
    return boxes[i].squaredExteriorDistance(p) <= within * within && exact_distance(p, triangles[i]) <= within;
  }
  std::vector<Corners> triangles;
  std::vector<Eigen::AlignedBox3d> boxes;
};

struct Truth {
  int near = 0;          // triangle pairs within the tolerance
  int missed = 0;        // of these, the number without a point pair on both triangles
  double least = 1e300;  // m, when within the tolerance
};

inline bool covered(const Placed& a, std::size_t i, const Placed& b, std::size_t j,
                    const MeshContactResult& found) {
  for (const PointPair& p : found.pairs)
    if (p.triangle_a == static_cast<int>(i) && p.triangle_b == static_cast<int>(j)) return true;
  for (const PointPair& p : found.pairs)
    if (a.near(i, p.on_a_m, kAfterMerge_m) && b.near(j, p.on_b_m, kAfterMerge_m)) return true;
  return false;
}

// Compares all triangle pairs with the result.
inline Truth compare(const Placed& a, const Placed& b, double tolerance_m, const MeshContactResult& found) {
  Truth truth;
  for (std::size_t i = 0; i < a.triangles.size(); ++i)
    for (std::size_t j = 0; j < b.triangles.size(); ++j) {
      if (a.boxes[i].squaredExteriorDistance(b.boxes[j]) > tolerance_m * tolerance_m) continue;
      const double d = exact_distance(a.triangles[i], b.triangles[j]);
      if (d > tolerance_m - 1e-9) continue;
      truth.near++;
      truth.least = std::min(truth.least, d);
      truth.missed += !covered(a, i, b, j, found);
    }
  return truth;
}

// No false pair and no duplicate, in any mode.
inline void check_sound(const Placed& a, const Placed& b, double tolerance_m, const MeshContactResult& found) {
  for (const PointPair& p : found.pairs) {
    const auto i = static_cast<std::size_t>(p.triangle_a), j = static_cast<std::size_t>(p.triangle_b);
    const double off =
        std::max(exact_distance(p.on_a_m, a.triangles[i]), exact_distance(p.on_b_m, b.triangles[j]));
    if (off > 1e-9) CHECK(off <= 1e-9);
    const Eigen::Vector3d direction = p.on_b_m - p.on_a_m;
    if (p.gap_m > tolerance_m || p.gap_m < 0) CHECK(p.gap_m == Approx(tolerance_m / 2));
    if (std::abs(p.normal.norm() - 1) > 1e-9) CHECK(p.normal.norm() == Approx(1));
    if ((direction - p.gap_m * p.normal).norm() > 1e-9) CHECK((direction - p.gap_m * p.normal).norm() <= 1e-9);
  }
  int duplicates = 0;
  for (std::size_t i = 0; i < found.pairs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) duplicates += same_pair(found.pairs[i], found.pairs[j]);
  CHECK(duplicates == 0);
}

// Moves b from far along a random direction to about `gap_m` from a. Each move is a distance that is safe.
inline Eigen::Isometry3d placed_near(const ContactMesh& a, const ContactMesh& b, Random& random, double from_m,
                                      double gap_m) {
  Eigen::Isometry3d pose = random_pose(random, 1);
  const Eigen::Vector3d towards = direction(random);
  pose.translation() = from_m * towards;
  for (int i = 0; i < 60; ++i) {
    const double d = least_gap_m(a, b, pose);
    if (d <= gap_m || pose.translation().dot(towards) < 0) break;
    pose.translation() -= (d - 0.9 * gap_m) * towards;
  }
  return pose;
}

// Number of pairs of x without an equal pair in y, each in its own frame.
inline int missing(const MeshContactResult& x, const MeshContactResult& y, const Eigen::Isometry3d& x_from_y,
                   bool swapped) {
  int count = 0;
  for (const PointPair& p : x.pairs) {
    bool found = false;
    for (const PointPair& q : y.pairs) {
      const Eigen::Vector3d a = x_from_y * (swapped ? q.on_b_m : q.on_a_m),
                            b = x_from_y * (swapped ? q.on_a_m : q.on_b_m);
      found = found || ((a - p.on_a_m).norm() <= kAfterMerge_m && (b - p.on_b_m).norm() <= kAfterMerge_m);
    }
    count += !found;
  }
  return count;
}

// Checks that the contact of a and b does not depend on the order of the meshes, the frame, or the winding and order
// of a's triangles. Returns the number of pairs.
inline int check_invariant(const Soup& a, const Soup& b, const Eigen::Isometry3d& pose_b, const Reach& reach,
                           Random& random) {
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity(), move = random_pose(random, 3);
  const auto mesh = [](const Soup& s) { return ContactMesh(s.vertices, s.indices); };
  const ContactMesh ma = mesh(a), mb = mesh(b);
  MeshContact contact;
  MeshContactResult found, other;
  contact.query(ma, here, mb, pose_b, reach, found);
  const auto same = [&](const Eigen::Isometry3d& back, bool swapped) {
    CHECK(missing(found, other, back, swapped) == 0);
    CHECK(other.pairs.size() == found.pairs.size());
    CHECK(other.pierced == found.pierced);
  };
  contact.query(mb, pose_b, ma, here, reach, other);
  same(here, true);
  contact.query(ma, move, mb, move * pose_b, reach, other);
  same(move.inverse(), false);
  Soup turned = a;
  for (std::size_t t = 0; t + 2 < turned.indices.size(); t += 3)
    std::swap(turned.indices[t], turned.indices[t + 2]);
  contact.query(mesh(turned), here, mb, pose_b, reach, other);
  same(here, false);
  Soup shuffled;
  std::vector<int> order(static_cast<std::size_t>(a.triangles()));
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = static_cast<int>(t);
  for (std::size_t t = order.size(); t > 1; --t) std::swap(order[t - 1], order[random() % t]);
  for (const int t : order) shuffled.add(a.corner(t, 1), a.corner(t, 2), a.corner(t, 0));
  contact.query(mesh(shuffled), here, mb, pose_b, reach, other);
  same(here, false);
  return static_cast<int>(found.pairs.size());
}

}  // namespace tactus::sim::test
