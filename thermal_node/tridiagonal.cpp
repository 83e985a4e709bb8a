#include "thermal_node/tridiagonal.h"

#include <cstddef>

namespace tactus::thermal {

void solve_tridiagonal(std::span<const double> lower, std::span<const double> centre,
                       std::span<const double> upper, std::span<double> right, std::span<double> scratch) {
  const std::size_t n = right.size();
  double pivot = centre[0];
  right[0] /= pivot;
  for (std::size_t i = 1; i < n; ++i) {
    scratch[i] = upper[i - 1] / pivot;
    pivot = centre[i] - lower[i] * scratch[i];
    right[i] = (right[i] - lower[i] * right[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) right[i] -= scratch[i + 1] * right[i + 1];
}

}  // namespace tactus::thermal
