#include "lcmtypes/friction_map.h"

#include "lcmtypes/relief.h"

namespace tactus {

FrictionMap::FrictionMap(const HeightMap& map, const material_def_t& material)
    : size_u_m_(material.friction_size_u_m),
      size_v_m_(material.friction_size_v_m),
      columns_(map.columns),
      rows_(map.rows) {
  factors_.reserve(map.levels.size());
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      factors_.push_back(static_cast<float>(
          material.friction_black + map.at(column, row) * (material.friction_white - material.friction_black)));
}

double FrictionMap::factor(const Eigen::Vector3d& normal_body, const Eigen::Vector3d& point_body_m) const {
  const BumpAxes axes = bump_axes(normal_body);
  const Texel t = texel_at({point_body_m[axes.u] / size_u_m_, point_body_m[axes.v] / size_v_m_}, columns_, rows_);
  const auto value = [&](int column, int row) {
    return static_cast<double>(factors_[static_cast<std::size_t>(row * columns_ + column)]);
  };
  const double below = value(t.left, t.below) + t.along_u * (value(t.right, t.below) - value(t.left, t.below));
  const double above = value(t.left, t.above) + t.along_u * (value(t.right, t.above) - value(t.left, t.above));
  return below + t.along_v * (above - below);
}

}  // namespace tactus
