// Matrices of the estimator and the controller. Their storage is inside the object: no allocation.
#pragma once

#include <Eigen/Core>

namespace tactus::observer {

constexpr int kMaxStates = 8;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

}  // namespace tactus::observer
