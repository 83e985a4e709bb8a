#include "haptic_node/contact/direct.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptic_node/contact/rigid_proxy.h"

namespace tactus::haptic {

void compute_direct_depths(std::span<Surface> surfaces, const DevicePose& placed, const DevicePose& device,
                           double lever_m, double tool_radius_m) {
  const std::size_t n = std::min(surfaces.size(), kMaxHalfSpaces);
  std::array<double, kMaxHalfSpaces> depth{};
  std::array<Vector6, kMaxHalfSpaces> direction;
  for (std::size_t i = 0; i < n; ++i) {
    Surface& s = surfaces[i];
    const Eigen::Vector3d arm = device.orientation * s.tool_point;
    depth[i] = std::max(
        0.0, s.offset_m + s.normal.dot(placed.orientation * s.tool_point) - s.normal.dot(device.position + arm));
    direction[i] << s.normal, (arm - tool_radius_m * s.normal).cross(s.normal) / lever_m;
    s.grip.setZero();
    s.stick_error.setZero();
    s.slipping = true;
  }
  // d_i d_i / (sum over j of d_j |way_i way_j|). A single surface has its own depth; equal surfaces share one
  // depth; a surface that begins to press begins at zero, so the force does not jump.
  for (std::size_t i = 0; i < n; ++i) {
    double coupled_m = 0;
    for (std::size_t j = 0; j < n; ++j)
      if (depth[j] > 0) coupled_m += depth[j] * std::abs(direction[i].dot(direction[j]));
    surfaces[i].depth_m = depth[i] > 0 ? depth[i] * depth[i] / coupled_m : 0;
  }
}

}  // namespace tactus::haptic
