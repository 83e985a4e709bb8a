// Reduces a contact to patches with few points, independent of the resolution of the meshes.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "sim_node/model/point_pair.h"

namespace tactus::sim {

inline constexpr int kMaxPatchPoints = 4;

// A part of a contact with one normal.
struct ContactPatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of its deepest pair, from a to b
  ContactKind kind = ContactKind::kPoint;             // by its extent
  double area_m2 = 0;                                 // of the hull of all its pairs in the tangent plane
  // The deepest pair and the corners of the patch. Each carries 1 / count of the stiffness, so that the stiffness of
  // the patch does not depend on the resolution.
  int count = 0;
  std::array<PointPair, kMaxPatchPoints> points;
  double share() const { return count > 0 ? 1.0 / count : 0; }
};

// Pairs whose normals differ by less than this belong to one patch: 10 degrees, as for a tool's planes (setting
// touch_merge_angle).
inline constexpr double kPatchAngle_rad = 0.1745;

class Patches {
 public:
  // Writes the patches, deepest first, into `out`, after clearing it. Drops oblique pairs beside a patch. The result
  // does not depend on the order of the pairs. tolerance_m: points closer than this are one place. Real-time safe
  // once the lists have grown.
  void make(std::span<const PointPair> pairs, double tolerance_m, std::vector<ContactPatch>& out,
            double angle_rad = kPatchAngle_rad);

 private:
  void gather(std::size_t first, const ContactPatch& patch, double alike);
  void drop_oblique(std::size_t first, const ContactPatch& patch, double tolerance_m);
  void choose(double tolerance_m, ContactPatch& patch) const;

  std::vector<const PointPair*> order_, patch_;
  std::vector<bool> taken_;
  std::vector<Eigen::Vector2d> flat_, hull_;
  Eigen::AlignedBox2d box_;
};

}  // namespace tactus::sim
