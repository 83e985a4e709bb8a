// A small world for touch tests: a scene with one tool, planes, touch models and a manual clock.
#pragma once

#include <algorithm>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>
#include <vector>

#include "haptic_node/rendering/renderer.h"
#include "haptic_node/contact/surfaces.h"
#include "lcmtypes/vectors.h"
#include "tests/haptic_node/support/tick.h"

namespace tactus::haptic::test {

using Eigen::Vector3d;

// Host time at which simulated time is zero.
inline constexpr std::int64_t kStart = 5'000 * kMs;
inline sync::HostTime host_ms(double ms) { return sync::host_time(kStart + static_cast<std::int64_t>(ms * 1e6)); }

inline touch_plane_t plane(std::int64_t id, const Vector3d& point, const Vector3d& normal, double friction = 0) {
  touch_plane_t p{};
  p.contact_id = id;
  p.body = 0;
  p.material = -1;
  p.point_m = to_vec3(point);
  p.normal = to_vec3f(normal.normalized());
  p.effective_mass_kg = 1e10f;
  p.stiffness_N_m = 1000;
  p.friction_static = p.friction_dynamic = static_cast<float>(friction);
  return p;
}

inline touch_model_t model(double sim_ms, std::vector<touch_plane_t> planes, int tool = 0) {
  touch_model_t m{};
  m.header.sim_time_ns = static_cast<std::int64_t>(sim_ms * 1e6);
  m.header.incarnation = m.header.run_id = 1;
  m.clock.sim_ns = m.header.sim_time_ns;
  m.clock.host_ns = kStart + m.header.sim_time_ns;
  m.clock.rate = 1;
  m.tool = tool;
  m.pages = 1;
  m.plane_count = static_cast<std::int8_t>(planes.size());
  m.planes = std::move(planes);
  return m;
}

// A static floor (body 0) and a tool of 5 mm (body 1).
inline scene_t scene(double radius_m = 0.005) {
  scene_t s{};
  s.step_ns = kMs;
  s.bodies.resize(2);
  s.bodies[1].id = 1;
  s.body_count = 2;
  s.tools.resize(1);
  s.tools[0].name = "stylus";
  s.tools[0].body = 1;
  s.tools[0].radius_m = radius_m;
  s.tools[0].mass_kg = 0.05;
  s.tool_count = 1;
  s.materials.resize(2);
  s.materials[0].youngs_modulus_Pa = 70e9;
  s.materials[1].youngs_modulus_Pa = 1e7;
  s.material_count = 2;
  return s;
}

inline contact_event_t event(std::int64_t id, std::int8_t kind, double sim_ms, std::int64_t contact = 7) {
  contact_event_t e{};
  e.event_id = id;
  e.contact_id = contact;
  e.kind = kind;
  e.time_ns = static_cast<std::int64_t>(sim_ms * 1e6);
  e.body_a = 0;
  e.body_b = 1;
  e.material_a = 0;
  e.material_b = -1;
  e.tool = 0;
  e.normal = to_vec3f(Vector3d::UnitZ());
  e.approach_speed_m_s = 0.1f;
  e.effective_mass_kg = 0.02f;
  return e;
}

// Part of the rise from `last` to `force` that the slew limit does not allow, N: the force may rise by rise_N above the part
// of the last one along it, and falls at once.
inline double beyond_slew_N(const Vector3d& force, const Vector3d& last, double rise_N) {
  const double size = force.norm();
  return size > 0 ? size - std::max(0.0, last.dot(force) / size) - rise_N : 0;
}

// Drives a renderer tick by tick with a device whose position the test sets.
struct Bench {
  explicit Bench(const Settings& s = {}, const scene_t& in_scene = scene())
      : safety(safety_limits(s)), renderer(in_scene, 0, s, safety) {}

  // One tick at `ms` of simulated time; the model, if any, arrives at the same time. in: other input.
  TickOutput& tick(double ms, const Vector3d& device, const touch_model_t* fresh = nullptr,
                   std::vector<contact_event_t> events = {}, TickInput in = {}) {
    in.now = host_ms(ms);
    in.device.position = device;
    in.device.velocity = last ? Vector3d((device - *last) / ((ms - last_ms) * 1e-3)) : Vector3d::Zero();
    last = device;
    last_ms = ms;
    if (fresh) arrival = in.now;
    in.fresh = fresh;
    in.touch_arrival = arrival;
    if (arrival) in.map = sync::TimeMap{sync::sim_time(0), host_ms(0), 1};
    in.events = events;
    return renderer.step(in);
  }

  Safety safety;
  Renderer renderer;
  std::optional<Vector3d> last;
  double last_ms = 0;
  std::optional<sync::HostTime> arrival;
};

}  // namespace tactus::haptic::test
