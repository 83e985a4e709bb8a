#include "visual_node/overlay/contact_strokes.h"

#include <algorithm>
#include <tactus/contact_point_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::visual {
namespace {

// design: they differ in lightness too, and none has the colour of a flash.
const Pen kOfTool{{1.0f, 0.9f, 0.2f, 1}}, kOfOthers{{0.3f, 1.0f, 0.4f, 1}};
const Pen kForce{{1.0f, 0.35f, 0.3f, 1}, 3}, kHandForce{{1.0f, 0.4f, 1.0f, 1}, 3};
const Pen kSpring{{0.9f, 0.9f, 1.0f, 0.9f}}, kProxy{{1, 1, 1, 1}, 2}, kDevice{{1, 1, 1, 0.5f}, 1};
constexpr float kAxis_m = 0.04f, kSpringWidth_m = 0.012f;
constexpr double kApart_m = 1e-3;  // below this distance of proxy and device the spring is not drawn

Eigen::Vector3f middle(const contact_point_t& p, const Eigen::Vector3d& origin_m) {
  return ((to_eigen(p.a_world_m) + to_eigen(p.b_world_m)) / 2 - origin_m).cast<float>();
}

Eigen::Isometry3d pose_about(const Eigen::Isometry3d& pose, const Eigen::Vector3d& origin_m) {
  return Eigen::Translation3d(-origin_m) * pose;
}

std::span<const contact_t> drawn(std::span<const contact_t> contacts) {
  return contacts.first(std::min(contacts.size(), kMaxContactsDrawn));
}

}  // namespace

void append_contacts(std::vector<Stroke>& out, std::span<const contact_t> contacts, const Eigen::Vector3d& origin_m) {
  for (const contact_t& c : drawn(contacts)) {
    const Pen& pen = c.tool >= 0 ? kOfTool : kOfOthers;
    const Eigen::Vector3f normal = to_eigen(c.normal).cast<float>();
    for (const contact_point_t& p : c.points) {
      const Eigen::Vector3f at = middle(p, origin_m);
      append_cross(out, at, kNormal_m / 2, pen);
      append_line(out, at, at + normal * kNormal_m, pen);
    }
  }
}

void append_contact_forces(std::vector<Stroke>& out, std::span<const contact_t> contacts, float scale_m_N,
                           const Eigen::Vector3d& origin_m) {
  for (const contact_t& c : drawn(contacts)) {
    if (c.points.empty() || c.normal_force_N <= 0) continue;
    Eigen::Vector3f at = Eigen::Vector3f::Zero();
    for (const contact_point_t& p : c.points) at += middle(p, origin_m) / static_cast<float>(c.points.size());
    append_arrow(out, at, to_eigen(c.normal).cast<float>() * c.normal_force_N * scale_m_N, kForce);
  }
}

void append_hand_force(std::vector<Stroke>& out, const ToolPose& pose, const Eigen::Vector3d& force_N,
                       float scale_m_N, const Eigen::Vector3d& origin_m) {
  if (!pose.known) return;
  append_arrow(out, pose_about(pose.proxy, origin_m).translation().cast<float>(), force_N.cast<float>() * scale_m_N,
               kHandForce);
}

void append_tool(std::vector<Stroke>& out, const ToolPose& pose, const Eigen::Vector3d& origin_m) {
  if (!pose.known) return;
  const Eigen::Isometry3d proxy = pose_about(pose.proxy, origin_m), device = pose_about(pose.device, origin_m);
  append_axes(out, proxy, kAxis_m, kProxy);
  append_axes(out, device, kAxis_m, kDevice);
  if ((pose.device.translation() - pose.proxy.translation()).norm() > kApart_m)
    append_spring(out, proxy.translation().cast<float>(), device.translation().cast<float>(), kSpringWidth_m, kSpring);
}

}  // namespace tactus::visual
