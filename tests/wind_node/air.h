// The air that a passing body moves. Pure.
#pragma once

#include <Eigen/Core>
#include <tactus/shape_def_t.hpp>

namespace tactus::wind {

// Velocity of the air at `at` around a sphere that moves through it at rest, m/s: the dipole of potential flow, u
// = R^3 / (2 r^3) (3 (v.e) e - v) (Lamb 1932, Hydrodynamics, art. 92). It falls with the cube of the distance;
// inside of the sphere it is that at its surface.
Eigen::Vector3d air_velocity_m_s(const Eigen::Vector3d& at, const Eigen::Vector3d& centre, double radius_m,
                                 const Eigen::Vector3d& velocity_m_s);

// Radius of the sphere of the same volume, m; of what has no size of its own: otherwise_m.
double equivalent_radius_m(const shape_def_t& shape, double otherwise_m);

}  // namespace tactus::wind
