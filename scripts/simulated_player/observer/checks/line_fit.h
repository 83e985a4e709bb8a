// The straight line through points of equal weight. Pure.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::observer {

struct Line {
  double slope = 0, intercept = 0, r2 = 0;
};

// Least squares. Needs two different x; r2 needs two different y.
inline Line fit_line(std::span<const double> x, std::span<const double> y) {
  const double n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx), xy += (x[i] - mx) * (y[i] - my), yy += (y[i] - my) * (y[i] - my);
  }
  return {xy / xx, my - xy / xx * mx, xy * xy / (xx * yy)};
}

}  // namespace tactus::observer
