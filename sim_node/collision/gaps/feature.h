// What a convex core turns towards a direction, as a flat figure, and where two such figures face each other: the
// corners of a contact. The same figures have the same points in the same order, from step to step. Pure.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "sim_node/collision/gaps/convex.h"

namespace tactus::sim::gaps {

struct Feature {
  enum class Kind { kPoint, kSegment, kPolygon, kDisc };
  Kind kind = Kind::kPoint;
  int count = 0;                           // of corners; of a disc: four points of its rim
  std::array<Eigen::Vector3d, 4> corners;  // in order around
  Eigen::Vector3d normal{0, 0, 1};         // unit, of its plane, out of the body
  Eigen::Vector3d centre{0, 0, 0};         // of a disc
  double radius_m = 0;
};

// In the frame that `to` maps to; `along` is unit and of that frame.
Feature feature_along(const Convex& c, const Eigen::Isometry3d& to, const Eigen::Vector3d& along);

// A place where two figures face each other along n, with its height on either.
struct Facing {
  Eigen::Vector3d on_a, on_b;
  double gap_m;  // along n
};
struct FacingList {
  static constexpr int kMax = 40;  // two discs or a disc and a box have at most 18, two quadrilaterals 24
  int count = 0;
  std::array<Facing, kMax> at;
  void add(const Facing& f) {
    if (count < kMax) at[static_cast<std::size_t>(count++)] = f;
  }
};

// The corners of what both cover, seen along n (unit, from a to b), as far as their gap is within the reach. `a`
// turns towards n, `b` towards -n.
void facing(const Feature& a, const Feature& b, const Eigen::Vector3d& n, double reach_m, FacingList& out);

// Of a figure over the half space n x <= offset: its own corners, and of a disc the lowest point of its rim.
void facing_plane(const Feature& of, const Eigen::Vector3d& n, double offset_m, double reach_m, FacingList& out);

}  // namespace tactus::sim::gaps
