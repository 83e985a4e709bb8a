// One relief at ever coarser grids, so that what slides fast over a fine map does not alias: a mipmap (Williams
// 1983, "Pyramidal Parametrics") that is read along a track. Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lcmtypes/relief.h"

namespace tactus::audio {

class ReliefLevels {
 public:
  explicit ReliefLevels(Relief finest);

  // Slope, m/m, at a place in repetitions, of the relief without what a sample can not hold when each goes on by
  // so many repetitions along u and v. Realtime-safe: yes.
  Eigen::Vector2d slope(const Eigen::Vector2d& at, const Eigen::Vector2d& step) const;
  const Relief& finest() const { return levels_.front(); }
  double texel_m() const;  // the smaller side of a pixel

 private:
  std::vector<Relief> levels_;  // each of half the columns and rows of the one before, down to a single pixel
};

}  // namespace tactus::audio
