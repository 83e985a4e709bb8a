// The pose of a rigid tool that is closest to a goal while each tool point that may meet a surface stays on its
// allowed side: the quadratic programme of the proxy with six degrees of freedom (least constraint of Gauss:
// Ortega, Redon and Coquillart 2007). Minimise |q - goal|^2 so that normal_i . q >= offset_i, where q is a small
// motion: three coordinates of translation in metres, three of rotation times a lever.
//
// Solved by the dual active set method (Goldfarb and Idnani 1983), which is short for this metric. Starting at the
// goal, it adds the most violated half space and drops those whose multiplier would become negative. Each
// iteration increases the distance from the goal, so no set repeats. It is exact, at most six half spaces bind,
// and it keeps no state between ticks.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "haptic_node/contact/closest_point.h"

namespace tactus::haptic {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct PoseHalfSpace {
  Vector6 normal = Vector6::Zero();  // into the allowed side; any length but 0
  double offset = 0;
};

// The binding half spaces: at most six, linearly independent.
class BindingSet {
 public:
  std::size_t size() const { return size_; }
  std::size_t member(std::size_t k) const { return member_[k]; }
  // The part of v orthogonal to all binding normals.
  Vector6 free_part(const Vector6& v) const;
  // Coefficients c with (sum of c_k normal_k) . normal_j = rate_j: the shares of the normals in a motion with
  // these rates.
  std::array<double, 6> shares(const std::array<double, 6>& rates) const;

  // Adds a normal; false when it depends on the normals added before.
  bool add(std::size_t index, const Vector6& normal);
  void drop(std::size_t k);
  void clear() { size_ = 0; }
  // v in terms of the binding normals, least squares.
  std::array<double, 6> coefficients(const Vector6& v) const;

 private:
  std::size_t size_ = 0;
  std::array<std::size_t, 6> member_{};
  std::array<Vector6, 6> normal_, basis_;            // as given; orthonormalised, in order
  std::array<std::array<double, 6>, 6> triangle_{};  // normal_j = sum over i <= j of triangle_[i][j] basis_i
};

struct ClosestPose {
  Vector6 pose = Vector6::Zero();
  // pose = goal + sum of multiplier_i normal_i, all >= 0.
  std::array<double, kMaxHalfSpaces> multiplier{};
  BindingSet binding;
  // False: the half spaces have no common pose. Then `pose` approximately minimises the sum of squared violations,
  // the multipliers are 0 and nothing binds.
  bool feasible = true;
};

// Distributes a sum over normals, sum = sum of share_i normal_i, with (nearly) the least sum of share_i^2 /
// weight_i and shares that are not negative. The programme itself does not determine the shares where more half
// spaces bind than necessary, for example at the four feet of a table. Normals of weight 0 get no share. Returns
// false, with `shares` unchanged, when there is no such distribution. Realtime-safe: yes.
bool distribute(std::span<const PoseHalfSpace> region, std::span<const double> weights, const Vector6& sum,
                std::span<double> shares);

// At most kMaxHalfSpaces; more are ignored. Realtime-safe: yes.
ClosestPose closest_pose(std::span<const PoseHalfSpace> region, const Vector6& goal);

}  // namespace tactus::haptic
