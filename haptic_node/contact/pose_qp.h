// The pose of a rigid tool that is closest to a goal where each of its points that may meet a surface stays on its
// side: the quadratic programme behind the proxy with six degrees of freedom (Gauss' least constraint: Ortega,
// Redon and Coquillart 2007). Minimise |q - goal|^2 so that normal_i . q >= offset_i, where q is a small motion:
// three metres of translation, three of rotation times a lever.
//
// By the dual active set method (Goldfarb and Idnani 1983), which for this metric is short: from the goal, the
// half space that is violated most is taken in, and those whose multiplier would turn negative on the way are let
// go. Each turn takes the pose farther from the goal, so no set comes back: exact, at most six bind, no state from
// tick to tick.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "haptic_node/contact/closest_point.h"

namespace tactus::haptic {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct PoseHalfSpace {
  Vector6 normal = Vector6::Zero();  // into the allowed side; of any length but 0
  double offset = 0;
};

// The half spaces that bind, at most six, independent of one another.
class BindingSet {
 public:
  std::size_t size() const { return size_; }
  std::size_t member(std::size_t k) const { return member_[k]; }
  // Of v, what no binding normal sees.
  Vector6 free_part(const Vector6& v) const;
  // Coefficients c with (sum of c_k normal_k) . normal_j = rate_j: how a motion into all of them is shared.
  std::array<double, 6> shares(const std::array<double, 6>& rates) const;

  // Puts another in; false when it depends on those that are there.
  bool add(std::size_t index, const Vector6& normal);
  void drop(std::size_t k);
  void clear() { size_ = 0; }
  // v in terms of the binding normals, least squares.
  std::array<double, 6> coefficients(const Vector6& v) const;

 private:
  std::size_t size_ = 0;
  std::array<std::size_t, 6> member_{};
  std::array<Vector6, 6> normal_, basis_;            // as given; made orthonormal, in order
  std::array<std::array<double, 6>, 6> triangle_{};  // normal_j = sum over i <= j of triangle_[i][j] basis_i
};

struct ClosestPose {
  Vector6 pose = Vector6::Zero();
  // pose = goal + sum of multiplier_i normal_i, all >= 0.
  std::array<double, kMaxHalfSpaces> multiplier{};
  BindingSet binding;
  // False: the half spaces have no pose in common. Then the squares of the violations of `pose` are least
  // (nearly), the multipliers are 0 and nothing binds.
  bool feasible = true;
};

// Shares of a sum over normals, sum = sum of share_i normal_i, the least by share_i^2 / weight_i that are not
// negative (nearly): where more bind than are needed, as at the four feet of a table, what carries how much is not
// said by the programme. Those of weight 0 get none. False: it could not be done, and `shares` is as it was.
// Realtime-safe: yes.
bool spread(std::span<const PoseHalfSpace> region, std::span<const double> weights, const Vector6& sum,
            std::span<double> shares);

// At most kMaxHalfSpaces; more are ignored. Realtime-safe: yes.
ClosestPose closest_pose(std::span<const PoseHalfSpace> region, const Vector6& goal);

}  // namespace tactus::haptic
