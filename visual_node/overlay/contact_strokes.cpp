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

Eigen::Vector3f middle(const contact_point_t& p) {
  return (to_eigen(p.a_world_m) + to_eigen(p.b_world_m)).cast<float>() / 2;
}

std::span<const contact_t> drawn(std::span<const contact_t> contacts) {
  return contacts.first(std::min(contacts.size(), kMaxContactsDrawn));
}

}  // namespace

void append_contacts(std::vector<Stroke>& out, std::span<const contact_t> contacts) {
  for (const contact_t& c : drawn(contacts)) {
    const Pen& pen = c.tool >= 0 ? kOfTool : kOfOthers;
    const Eigen::Vector3f normal = to_eigen(c.normal).cast<float>();
    for (const contact_point_t& p : c.points) {
      append_cross(out, middle(p), kNormal_m / 2, pen);
      append_line(out, middle(p), middle(p) + normal * kNormal_m, pen);
    }
  }
}

void append_contact_forces(std::vector<Stroke>& out, std::span<const contact_t> contacts, float scale_m_N) {
  for (const contact_t& c : drawn(contacts)) {
    if (c.points.empty() || c.normal_force_N <= 0) continue;
    Eigen::Vector3f at = Eigen::Vector3f::Zero();
    for (const contact_point_t& p : c.points) at += middle(p) / static_cast<float>(c.points.size());
    append_arrow(out, at, to_eigen(c.normal).cast<float>() * c.normal_force_N * scale_m_N, kForce);
  }
}

void append_hand_force(std::vector<Stroke>& out, const ToolPose& pose, const tool_state_t& state,
                       float scale_m_N) {
  if (!pose.known) return;
  append_arrow(out, pose.proxy.translation().cast<float>(), to_eigen(state.force_N).cast<float>() * scale_m_N,
               kHandForce);
}

void append_tool(std::vector<Stroke>& out, const ToolPose& pose) {
  if (!pose.known) return;
  append_axes(out, pose.proxy, kAxis_m, kProxy);
  append_axes(out, pose.device, kAxis_m, kDevice);
  if ((pose.device.translation() - pose.proxy.translation()).norm() > kApart_m)
    append_spring(out, pose.proxy.translation().cast<float>(), pose.device.translation().cast<float>(),
                  kSpringWidth_m, kSpring);
}

}  // namespace tactus::visual
