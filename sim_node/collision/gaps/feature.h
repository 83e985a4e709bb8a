// The feature of a convex core that faces a direction, as a flat figure, and the overlap of two such figures: the
// corners of a contact. Equal figures give equal points in equal order, from step to step. Pure.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "sim_node/collision/gaps/convex.h"

namespace tactus::sim::gaps {

struct Feature {
  enum class Kind { kPoint, kSegment, kPolygon, kDisc };
  Kind kind = Kind::kPoint;
  int count = 0;                           // number of corners; a disc has four points of its rim
  std::array<Eigen::Vector3d, 4> corners;  // in order around the outline
  Eigen::Vector3d normal{0, 0, 1};         // unit, of its plane, outward
  Eigen::Vector3d centre{0, 0, 0};         // of a disc
  double radius_m = 0;
};

// The result is in the frame that `to` maps to. `along` is a unit vector in that frame.
Feature feature_along(const Convex& c, const Eigen::Isometry3d& to, const Eigen::Vector3d& along);

// A point where two figures face each other along n, with its position on either.
struct FacingPoint {
  Eigen::Vector3d on_a, on_b;
  double gap_m;  // along n
};
struct FacingPoints {
  static constexpr int kMax = 40;  // two discs or a disc and a box have at most 18, two quadrilaterals 24
  int count = 0;
  std::array<FacingPoint, kMax> at;
  void add(const FacingPoint& f) {
    if (count < kMax) at[static_cast<std::size_t>(count++)] = f;
  }
};

// Corners of the overlap, seen along n (unit, from a to b), with a gap of at most reach_m. `a` faces n, `b` faces -n.
void facing(const Feature& a, const Feature& b, const Eigen::Vector3d& n, double reach_m, FacingPoints& out);

// Corners of a figure against the half space n . x <= offset_m. For a disc also the lowest point of its rim.
void facing_plane(const Feature& of, const Eigen::Vector3d& n, double offset_m, double reach_m, FacingPoints& out);

}  // namespace tactus::sim::gaps
