#include "sim_node/touch/tool_touch.h"

#include <algorithm>
#include <cmath>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {
namespace {

// Maximum number of surfaces near one tool.
constexpr std::size_t kMaxNear = 1 << 16;

}  // namespace

void ToolTouch::archive(StateArchive& a) {
  a.list(near_, kMaxNear, [&](Near& n) {
    a(n.contact_id);
    auto surface = static_cast<std::int64_t>(n.surface);
    a(surface);
    a.require(surface >= 0 && surface < static_cast<std::int64_t>(surfaces_.size()),
              "the state belongs to another scene");
    n.surface = static_cast<std::size_t>(surface);
    a(n.plane.point), a(n.plane.normal), a(n.plane.distance_m), a(n.last_seen), a(n.gap_m);
    a(n.touching), a(n.apart), a(n.separated_since), a(n.has_hit), a(n.last_hit), a(n.force_N), a(n.impulse_N_s);
    a(n.device_gap_m), a(n.has_device_gap), a(n.closing_m_s);
    if (shape_) a(n.tool_point_m);
  });
  a.fixed(surfaces_, [&](Surface& s) { a(s.friction_static), a(s.friction_dynamic); });
  a(has_message_), a(proxy_), a(device_), a(velocity_), a(proxy_velocity_), a(last_message_), a(last_stamp_), a(late_until_);
  if (shape_) a(spin_), a(proxy_orientation_), a(device_orientation_);
  a.message(model_);
}

void ToolTouch::rename() {
  for (Near& n : near_) n.contact_id = ids_.renamed(n.contact_id);
  for (touch_plane_t& p : model_.planes) p.contact_id = ids_.renamed(p.contact_id);
}

void ToolTouch::set_friction(int body, double friction) {
  for (Surface& s : surfaces_) {
    if (s.traits.body != body) continue;
    s.friction_static = std::sqrt(friction * tool_static_friction_);
    s.friction_dynamic = std::sqrt(friction * tool_dynamic_friction_);
  }
}

void ToolTouch::update_at_rest(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const tool_state_t> new_messages) {
  if (!new_messages.empty()) {
    set_proxy(new_messages.back(), now);
    velocity_ = to_eigen(new_messages.back().device_velocity_m_s);
    if (shape_) {
      spin_ = to_eigen(new_messages.back().device_spin_rad_s);
      device_orientation_ = to_eigen(new_messages.back().device.orientation).normalized();
    }
  }
  // Surfaces found earlier at this instant must be found again.
  for (Near& n : near_) n.last_seen = std::min(n.last_seen, now - sync::Nanoseconds(1));
  find_surfaces(now, bodies);
  write_model(now, bodies);
}

}  // namespace tactus::sim
