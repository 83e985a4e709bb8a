// Contacts, forces and tools as lines in space, from the state of the simulation. Pure.
#pragma once

#include <span>
#include <tactus/contact_t.hpp>
#include <vector>

#include "visual_node/overlay/strokes.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

// Limit of drawn contacts; further ones are left out.
inline constexpr std::size_t kMaxContactsDrawn = 2048;
// Length of a normal, m; the cross at a point is half as long.
inline constexpr float kNormal_m = 0.03f;

// A cross and the normal at each contact point: yellow if a tool takes part in the contact, otherwise green.
// origin_m, here and below: origin of the picture, m, world.
void append_contacts(std::vector<Stroke>& out, std::span<const contact_t> contacts,
                     const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero());
// The normal force on body b, from the mean of the points; scale: m of arrow for each newton.
void append_contact_forces(std::vector<Stroke>& out, std::span<const contact_t> contacts, float scale_m_N,
                           const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero());
// The force on a hand, at its proxy.
void append_hand_force(std::vector<Stroke>& out, const ToolPose& pose, const Eigen::Vector3d& force_N, float scale_m_N,
                       const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero());
// Axes of the proxy, fainter axes of the device, and the spring between them when they are apart.
void append_tool(std::vector<Stroke>& out, const ToolPose& pose, const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero());

}  // namespace tactus::visual
