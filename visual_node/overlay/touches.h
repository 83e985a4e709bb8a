// Contacts, forces and tools as lines in space: what the physics says of what the picture shows. Pure.
#pragma once

#include <span>
#include <tactus/contact_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <vector>

#include "visual_node/overlay/strokes.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

// Of a world with more contacts the first are drawn.
inline constexpr std::size_t kMaxContactsDrawn = 2048;
// Length of a normal, m; of the cross at a point half of it.
inline constexpr float kNormal_m = 0.03f;

// A cross at each of its points, and its normal from there: yellow a contact that a tool takes part in, green any
// other.
void append_contacts(std::vector<Stroke>& out, std::span<const contact_t> contacts);
// The normal force on body b, from the middle of the points; scale: m of arrow a newton.
void append_contact_forces(std::vector<Stroke>& out, std::span<const contact_t> contacts, float scale_m_N);
// The force on a hand, where its proxy is.
void append_hand_force(std::vector<Stroke>& out, const ToolPose& pose, const tool_state_t& state, float scale_m_N);
// Axes of the proxy, fainter those of the device, and the spring between them when they are apart.
void append_tool(std::vector<Stroke>& out, const ToolPose& pose);

}  // namespace tactus::visual
