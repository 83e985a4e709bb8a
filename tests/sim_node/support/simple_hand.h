// A tool in a world, and a simulated hand that holds it.
#pragma once

#include <algorithm>
#include <map>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"
#include "tests/sim_node/support/small_worlds.h"

namespace tactus::sim::test {

inline WorldDef& add_tool(WorldDef& w, const Eigen::Vector3d& place, double radius = 0.01) {
  const int body = add_body(w, "hand", 0, Eigen::Matrix3d::Identity(), at(place.x(), place.y(), place.z()));
  w.bodies.back().tool = static_cast<int>(w.tools.size());
  w.bodies.back().is_static = false;
  tool_def_t t{};
  t.name = "hand";
  t.body = body;
  t.radius_m = radius;
  t.mass_kg = 0.1;
  t.material = -1;
  w.tools.push_back(t);
  return w;
}

// Minimal haptic loop: the device follows a given path, the proxy stays outside the planes (one at a time), with a
// spring force between them.
struct Hand {
  double radius, stiffness = 1000;
  std::int64_t seq = 0, incarnation = 40;
  Eigen::Vector3d last;
  std::map<std::int64_t, Eigen::Vector3d> impulses{};
  std::map<std::int64_t, std::int64_t> begun_ns{};  // begin of each of these sums, on the clock of publish_time_ns

  // Skin radius of a plane's contact point. A ball has its radius, since its centre is its only point. The points of
  // a tool with a shape, which this hand never rotates, have none.
  double skin(const touch_plane_t& p) const { return to_eigen(p.tool_point_m).isZero(0) ? radius : 0; }

  tool_state_t tick(const touch_model_t& model, const Eigen::Vector3d& device, std::int64_t time_ns) {
    tool_state_t m{};
    m.header.sim_time_ns = time_ns;
    m.header.publish_time_ns = 1'000'000'000 + time_ns;
    m.header.incarnation = incarnation;
    m.header.seq = seq++;
    Eigen::Vector3d proxy = device;
    for (int round = 0; round < 4; ++round)
      for (const touch_plane_t& p : model.planes) {
        const Eigen::Vector3d n = to_eigen(p.normal).normalized();
        const double gap = (proxy + to_eigen(p.tool_point_m) - to_eigen(p.point_m)).dot(n) - skin(p);
        if (gap < 0) proxy -= gap * n;
      }
    for (const touch_plane_t& p : model.planes) {
      const Eigen::Vector3d n = to_eigen(p.normal).normalized();
      const double depth = skin(p) - (device + to_eigen(p.tool_point_m) - to_eigen(p.point_m)).dot(n);
      if (depth > 0) {
        impulses.try_emplace(p.contact_id, Eigen::Vector3d::Zero()).first->second += stiffness * depth * 0.001 * n;
        begun_ns.try_emplace(p.contact_id, m.header.publish_time_ns - 1);
      }
      if (!impulses.count(p.contact_id)) continue;
      tool_constraint_t c{};
      c.contact_id = p.contact_id;
      c.body = p.body;
      c.point_m = to_vec3(proxy + to_eigen(p.tool_point_m) - skin(p) * n);
      c.force_N = to_vec3f(Eigen::Vector3d(stiffness * std::max(0.0, depth) * n));
      c.impulse_N_s = to_vec3(impulses[p.contact_id]);
      c.impulse_since_ns = begun_ns[p.contact_id];
      m.constraints.push_back(c);
    }
    m.constraint_count = static_cast<std::int32_t>(m.constraints.size());
    m.device.position_m = to_vec3(device);
    m.proxy.position_m = to_vec3(proxy);
    m.device.orientation.w = m.proxy.orientation.w = 1;
    m.device_velocity_m_s =
        to_vec3f(seq > 1 ? Eigen::Vector3d((device - last) / 0.001) : Eigen::Vector3d(0, 0, 0));
    last = device;
    return m;
  }
};

}  // namespace tactus::sim::test
