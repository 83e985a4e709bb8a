// Friction map: the factor on friction at a place of a surface. Defined here once for simulation, haptics and
// sound, so that all cross a boundary at the same place. Pure.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <tactus/material_def_t.hpp>
#include <vector>

#include "lcmtypes/bump.h"
#include "lcmtypes/height_map.h"

namespace tactus {

class FrictionMap {
 public:
  FrictionMap(const HeightMap& map, const material_def_t& material);

  // Factor on the friction of the surface, >= 0, at a point of the body frame with this outward normal: that of
  // the grey at a pixel centre, bilinear in between. Placed like a relief (bump.h), with its own extents.
  // Realtime-safe: yes.
  double factor(const Eigen::Vector3d& normal_body, const Eigen::Vector3d& point_body_m) const;

 private:
  double size_u_m_, size_v_m_;
  int columns_, rows_;
  std::vector<float> factors_;
};

// Factor on the friction of a pair: the coefficient is the geometric mean of both surfaces (material_def_t), so a
// factor on one of them counts with its square root.
inline double pair_factor(double factor_of_one) { return std::sqrt(factor_of_one); }

}  // namespace tactus
