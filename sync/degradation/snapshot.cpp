#include "sync/degradation/snapshot.h"

#include <algorithm>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/random/keyed_random.h"

namespace tactus::sync {
namespace {

std::uint64_t key(const header_t& h, std::uint64_t which) {
  return mixed(mixed(static_cast<std::uint64_t>(h.incarnation), which), static_cast<std::uint64_t>(h.sim_time_ns));
}

// Applies the operators to the values of one contact, body or plane.
struct Changer {
  OperatorChain& stack;
  SimTime time, paced;
  std::int64_t id;
  std::int32_t material_a = -1, material_b = -1, body_a = -1, body_b = -1;
  int component = 0;

  template <class Number>
  void operator()(Quantity q, Number& x, double least = -1e300) {
    x = static_cast<Number>(
        std::max(least, stack.degraded_value(q, id, component++, x, time, material_a, material_b, body_a, body_b, paced)));
  }
  template <class Vector>
  void vector(Quantity q, Vector& v) {
    (*this)(q, v.x);
    (*this)(q, v.y);
    (*this)(q, v.z);
  }
};

}  // namespace

std::uint64_t stream_of(const contact_frame_t& m) { return 0x10u + static_cast<std::uint64_t>(m.group); }
std::uint64_t stream_of(const world_state_t& m) { return 0x20u + static_cast<std::uint64_t>(m.group); }
std::uint64_t stream_of(const touch_model_t& m) { return 0x1000u + static_cast<std::uint64_t>(m.tool); }
std::uint64_t stream_of(const tool_state_t& m) { return 0x2000u + static_cast<std::uint64_t>(m.tool); }

std::uint64_t snapshot_key(const contact_frame_t& m) { return key(m.header, stream_of(m)); }
std::uint64_t snapshot_key(const world_state_t& m) { return key(m.header, stream_of(m)); }
// A tool moves on while the world stands still, and all its messages then carry the same simulated time: the sequence number
// of the first page distinguishes them.
std::uint64_t snapshot_key(const touch_model_t& m) {
  return mixed(key(m.header, stream_of(m)), static_cast<std::uint64_t>(m.header.seq - m.page));
}
std::uint64_t snapshot_key(const tool_state_t& m) {
  return mixed(key(m.header, stream_of(m)), static_cast<std::uint64_t>(m.header.seq));
}

std::vector<Signal> signals_of(const contact_frame_t& m) {
  std::vector<Signal> signals;
  for (const contact_t& c : m.contacts) {
    signals.push_back({c.contact_id, Quantity::kForce, c.normal_force_N * to_eigen(c.normal)});
    signals.push_back({c.contact_id, Quantity::kVelocity, to_eigen(c.sliding_velocity_m_s)});
    signals.push_back({c.contact_id, Quantity::kPosition, c.depth_m * to_eigen(c.normal)});
  }
  return signals;
}

std::vector<Signal> signals_of(const world_state_t& m) {
  std::vector<Signal> signals;
  for (const body_state_t& b : m.bodies) {
    signals.push_back({b.body, Quantity::kVelocity, to_eigen(b.velocity_m_s)});
    signals.push_back({b.body, Quantity::kPosition, to_eigen(b.position_m)});
  }
  return signals;
}

std::vector<Signal> signals_of(const touch_model_t& m) {
  std::vector<Signal> signals;
  for (const touch_plane_t& p : m.planes) {
    signals.push_back({p.contact_id, Quantity::kVelocity, to_eigen(p.velocity_m_s)});
    signals.push_back({p.contact_id, Quantity::kPosition, to_eigen(p.point_m)});
  }
  for (const touch_applied_t& a : m.applied)
    signals.push_back({a.contact_id, Quantity::kImpulse, Eigen::Vector3d(to_eigen(a.impulse_N_s))});
  return signals;
}

std::vector<Signal> signals_of(const tool_state_t& m) {
  return {{m.tool, Quantity::kVelocity, to_eigen(m.proxy_velocity_m_s)},
          {m.tool, Quantity::kPosition, to_eigen(m.proxy.position_m)},
          {m.tool, Quantity::kForce, to_eigen(m.force_N)}};
}

void change_values(contact_frame_t& m, OperatorChain& stack, SimTime paced) {
  for (contact_t& c : m.contacts) {
    Changer change{stack, sim_time(m.header.sim_time_ns), paced, c.contact_id, c.material_a, c.material_b, c.body_a,
                   c.body_b};
    change(Quantity::kForce, c.normal_force_N, 0);
    change(Quantity::kPosition, c.depth_m);
    change.vector(Quantity::kVelocity, c.sliding_velocity_m_s);
    change.vector(Quantity::kVelocity, c.rolling_velocity_m_s);
  }
}

void change_values(world_state_t& m, OperatorChain& stack, SimTime paced) {
  for (body_state_t& b : m.bodies) {
    Changer change{stack, sim_time(m.header.sim_time_ns), paced, b.body, -1, -1, b.body, -1};
    change.vector(Quantity::kPosition, b.position_m);
    change.vector(Quantity::kVelocity, b.velocity_m_s);
  }
}

void change_values(touch_model_t& m, OperatorChain& stack, SimTime paced) {
  for (touch_plane_t& p : m.planes) {
    Changer change{stack, sim_time(m.header.sim_time_ns), paced, p.contact_id, p.material, -1, p.body, -1};
    change(Quantity::kStiffness, p.stiffness_N_m, 0);
    change.vector(Quantity::kPosition, p.point_m);
    change.vector(Quantity::kVelocity, p.velocity_m_s);
  }
}

void change_values(tool_state_t& m, OperatorChain& stack, SimTime paced) {
  Changer change{stack, sim_time(m.header.sim_time_ns), paced, m.tool};
  change.vector(Quantity::kForce, m.force_N);
  change.vector(Quantity::kPosition, m.device.position_m);
  change.vector(Quantity::kPosition, m.proxy.position_m);
  change.vector(Quantity::kVelocity, m.device_velocity_m_s);
  change.vector(Quantity::kVelocity, m.proxy_velocity_m_s);
}

void change_values(contact_event_t& e, OperatorChain& stack) {
  Changer change{stack, sim_time(e.time_ns), {}, e.contact_id, e.material_a, e.material_b, e.body_a, e.body_b};
  change(Quantity::kVelocity, e.approach_speed_m_s, 0);
}

bool make_zero(contact_frame_t& m) {
  m.contacts.clear();
  m.count = 0;
  return true;
}
bool make_zero(world_state_t&) { return false; }
bool make_zero(touch_model_t& m) {
  m.planes.clear();
  m.plane_count = 0;
  return true;
}
bool make_zero(tool_state_t&) { return false; }

}  // namespace tactus::sync
