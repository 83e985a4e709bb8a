// Where a surface is slippery and where it is rough: the factor of a material's friction map at a place. Defined
// here once for simulation, touch and sound, so that a boundary is crossed by all at the same place. Pure.
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

  // Factor on the friction of the surface, >= 0, at a point of the body frame where the outward normal is so: at
  // the middle of a pixel that of its grey, linear between. It lies on the surface as a relief does (bump.h), with
  // extents of its own. Realtime-safe: yes.
  double factor(const Eigen::Vector3d& normal_body, const Eigen::Vector3d& point_body_m) const;

 private:
  double size_u_m_, size_v_m_;
  int columns_, rows_;
  std::vector<float> factors_;
};

// A pair takes the geometric mean of the coefficients of its two surfaces (material_def_t), so of a factor on one
// of them it takes the root.
inline double pair_factor(double factor_of_one) { return std::sqrt(factor_of_one); }

}  // namespace tactus
