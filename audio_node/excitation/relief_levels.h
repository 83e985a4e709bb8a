// One relief at successively coarser grids, so that fast sliding over a fine map does not alias: a mipmap
// (Williams 1983, "Pyramidal Parametrics") that is read along a track. Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lcmtypes/relief.h"

namespace tactus::audio {

class ReliefLevels {
 public:
  explicit ReliefLevels(Relief finest);

  // Slope, m/m, at a place in repetitions, without the waves that samples at intervals of `step` repetitions along
  // u and v cannot represent. Realtime-safe: yes.
  Eigen::Vector2d slope(const Eigen::Vector2d& at, const Eigen::Vector2d& step) const;
  const Relief& finest() const { return levels_.front(); }
  double texel_m() const;  // the smaller side of a pixel

 private:
  std::vector<Relief> levels_;  // each with half the columns and rows of the previous one, down to a single pixel
};

}  // namespace tactus::audio
