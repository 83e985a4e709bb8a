// A contact as few points whose number does not depend on how finely the meshes are divided.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "sim_node/model/point_pair.h"

namespace tactus::sim {

inline constexpr int kMaxPatchPoints = 4;

// One stretch of contact with one direction.
struct ContactPatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of its deepest pair, from a to b
  ContactKind kind = ContactKind::kPoint;             // by its extent
  double area_m2 = 0;                                 // of the hull of all its pairs in the tangent plane
  // The deepest pair and the corners of the patch. Each carries 1 / count of the stiffness, so that the patch is
  // as stiff however finely it is divided.
  int count = 0;
  std::array<PointPair, kMaxPatchPoints> points;
  double share() const { return count > 0 ? 1.0 / count : 0; }
};

// Pairs whose normals differ by less are one patch: 10 degrees, as a tool's planes (setting touch_merge_angle).
inline constexpr double kPatchAngle_rad = 0.1745;

class Patches {
 public:
  // Patches by depth, the deepest first, into `out`, cleared first; pairs that lie askew beside a patch are left
  // out. The same pairs in another order give the same
  // patches. tolerance_m: what is closer together than this is one place. Realtime-safe once the lists have grown.
  void make(std::span<const PointPair> pairs, double tolerance_m, std::vector<ContactPatch>& out,
            double angle_rad = kPatchAngle_rad);

 private:
  void gather(std::size_t first, const ContactPatch& patch, double alike);
  void drop_askew(std::size_t first, const ContactPatch& patch, double tolerance_m);
  void choose(double tolerance_m, ContactPatch& patch) const;

  std::vector<const PointPair*> order_, patch_;
  std::vector<bool> taken_;
  std::vector<Eigen::Vector2d> flat_, hull_;
  Eigen::AlignedBox2d box_;
};

}  // namespace tactus::sim
