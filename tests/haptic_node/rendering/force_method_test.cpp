// The three rendering methods: each by itself, and switched while the hand is pressed.
#include "haptic_node/rendering/force_method.h"

#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/rendering/rigid_coupling.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;
using Eigen::Quaterniond;

namespace {

// A box of 40 x 60 x 20 mm in the hand, over a floor: the planes of its lower corners.
scene_t box_scene() {
  scene_t s = scene();
  s.tools[0].shape = tool_def_t::BOX;
  s.tools[0].size_m = {0.04, 0.06, 0.02};
  s.tools[0].radius_m = 0.5 * Vector3d(0.04, 0.06, 0.02).norm();
  return s;
}
std::vector<touch_plane_t> corners(double friction = 0) {
  std::vector<touch_plane_t> out;
  for (const double x : {-0.02, 0.02})
    for (const double y : {-0.03, 0.03}) {
      touch_plane_t p = plane(static_cast<std::int64_t>(out.size()) + 1, {x, y, 0}, Vector3d::UnitZ(), friction);
      p.tool_point_m = to_vec3f(Vector3d(x, y, -0.01));
      out.push_back(p);
    }
  return out;
}

struct BoxBench : Bench {
  explicit BoxBench(const Settings& s = {}) : Bench(s, box_scene()) {}
  TickOutput& press(double ms, const Vector3d& device, const Quaterniond& turn, double friction = 0) {
    const touch_model_t m = model(ms, corners(friction));
    TickInput in;
    in.device.orientation = turn;
    return tick(ms, device, &m, {}, in);
  }
};

Settings with(const std::string& rendering) {
  Settings s;
  s.rendering = rendering;
  return s;
}

Quaterniond about_y(double rad) { return Quaterniond(Eigen::AngleAxisd(rad, Vector3d::UnitY())); }

}  // namespace

TEST_CASE("The default method is rigid for a box and proxy for a ball") {
  CHECK(ForceMethod(box_scene().tools[0], {}).kind() == ForceMethod::Kind::kRigid);
  CHECK(ForceMethod(scene().tools[0], {}).kind() == ForceMethod::Kind::kProxy);
  CHECK(ForceMethod(scene().tools[0], with("rigid")).kind() == ForceMethod::Kind::kRigid);
  CHECK(ForceMethod(box_scene().tools[0], with("direct")).kind() == ForceMethod::Kind::kDirect);
}

TEST_CASE("Force and torque on the bodies equal those on the hand") {
  BoxBench bench;
  for (int ms = 0; ms < 300; ++ms) {
    const double in = std::min(1.0, ms / 100.0);
    TickOutput& out = bench.press(ms, {0.001 * in, 0, 0.012 - 0.005 * in}, about_y(0.005 * in), 0.3);
    Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
    for (const tool_constraint_t& c : out.state.constraints) {
      force += to_eigen(c.force_N);
      torque += (to_eigen(c.point_m) - to_eigen(out.state.proxy.position_m)).cross(to_eigen(c.force_N));
    }
    CHECK((force - out.force_N).norm() < 1e-5);
    if (ms > 200) CHECK((torque - out.torque_N_m).norm() < 1e-5);
    if (ms == 299) {
      CHECK(out.force_N.z() > 2);
      CHECK(out.torque_N_m.norm() > 0.005);
      CHECK(out.state.torque_N_m.y == Approx(out.torque_N_m.y()));
      CHECK(out.state.proxy.position_m.z == Approx(0.01).margin(1e-6));
    }
  }
}

TEST_CASE("A change of the method under pressure obeys the slew and settles within the recovery time") {
  const double depth = 0.002;
  for (const std::string from : {"direct", "proxy", "rigid"})
    for (const std::string to : {"direct", "proxy", "rigid"}) {
      CAPTURE(from, to);
      Settings settings = with(from);
      BoxBench bench(settings);
      Vector3d last = Vector3d::Zero(), last_torque = Vector3d::Zero();
      double most = 0, max_torque = 0, settled_N = 0;
      for (int ms = 0; ms < 400; ++ms) {
        if (ms == 200) {
          settings.rendering = to;
          bench.renderer.change(settings);
        }
        const double in = std::min(1.0, ms / 100.0);
        TickOutput& out = bench.press(ms, {0, 0, 0.011 - in * (0.001 + depth)}, about_y(0.004 * in), 0.3);
        if (ms >= 200) {
          most = std::max(most, (out.force_N - last).norm());
          max_torque = std::max(max_torque, (out.torque_N_m - last_torque).norm());
        }
        last = out.force_N, last_torque = out.torque_N_m;
        if (ms == 199) settled_N = out.force_N.z();
        if (ms == 230 && from == to) CHECK(out.force_N.z() == Approx(settled_N).epsilon(1e-3));
      }
      CHECK(settled_N > 1);
      CHECK(last.z() > 1);
      CHECK(most <= 0.5);  // far below the slew limit of 2 N a tick
      CHECK(max_torque <= 0.075);
      if (to == "proxy") CHECK(last_torque.norm() < 1e-9);
      if (to == "rigid") CHECK(last_torque.norm() > 0.005);
    }
}

TEST_CASE("All methods give equal forces for a ball on one plane") {
  double force[3];
  int k = 0;
  for (const std::string name : {"direct", "proxy", "rigid"}) {
    Bench bench(with(name));
    for (int ms = 0; ms < 200; ++ms) {
      const touch_model_t m = model(ms, {plane(1, Vector3d::Zero(), Vector3d::UnitZ(), 0.4)});
      force[k] = bench.tick(ms, {0, 0, 0.005 + 0.002 - 0.00002 * std::min(ms, 150)}, &m).force_N.z();
    }
    ++k;
  }
  CHECK(force[0] > 0.5);
  CHECK(force[1] == Approx(force[0]).epsilon(1e-3));
  CHECK(force[2] == Approx(force[0]).epsilon(1e-3));
}

TEST_CASE("The torque obeys its limits for any wanted torque") {
  Safety safety(SafetyLimits{});
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 200; ++i) {
    const double sign = i % 7 < 3 ? 1 : -1;
    const Vector3d wanted = i % 11 == 0 ? Vector3d::Constant(std::nan("")) : Vector3d(sign * 1e9, 3, -1e4);
    safety.begin_tick(host_ms(i));
    const Wrench w = safety.limit(Wrench{{0, 0, 100}, wanted}, Vector3d::Zero(), Vector3d::Zero(), 0.001);
    CHECK(w.torque_N_m.allFinite());
    CHECK(w.torque_N_m.norm() <= 0.3 + 1e-9);
    CHECK(beyond_slew_N(w.torque_N_m, last, 0.075) <= 1e-9);
    CHECK(w.force_N.norm() <= 8 + 1e-9);
    last = w.torque_N_m;
  }
}

TEST_CASE("The work of a torque on a rotating hand counts towards the energy limit") {
  SafetyLimits limits;
  limits.power_W = 0;
  Safety safety(limits);
  Wrench w;
  double given_J = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d turned(0, 0, 0.001);  // 1 rad/s with the torque
    given_J += w.torque_N_m.dot(turned);
    safety.begin_tick(host_ms(i));
    w = safety.limit(Wrench{Vector3d::Zero(), {0, 0, 0.3}}, Vector3d::Zero(), turned, 0.001);
  }
  CHECK(safety.energy_J() == Approx(given_J));
  CHECK(given_J <= limits.energy_J + 1e-3);
  CHECK(given_J > 0.5 * limits.energy_J);
}

TEST_CASE("Rotational stiffness follows the servo rate and the damping") {
  Settings s;
  const double usual = coupling_lever_m(s);
  CHECK(usual > 0.01);
  CHECK(usual < 0.2);
  s.device_turn_damping_Nms_rad /= 10;
  CHECK(coupling_lever_m(s) < usual);
}

TEST_CASE("Contradictory planes of a rigid tool keep force and torque within their limits") {
  BoxBench bench;
  Vector3d last = Vector3d::Zero(), last_torque = Vector3d::Zero();
  for (int ms = 0; ms < 300; ++ms) {
    std::vector<touch_plane_t> planes = corners(0.5);
    for (touch_plane_t& p : planes) {  // contradictory, distant, rotating
      const double k = std::sin(ms * 0.7 + static_cast<double>(p.contact_id));
      p.normal = to_vec3f(Vector3d(k, std::cos(3.0 * ms), 0.3).normalized());
      p.tool_point_m = to_vec3f(Vector3d(k, 5 * k, -1));
      p.angular_velocity_rad_s = to_vec3f(Vector3d(1e4 * k, 0, 0));
    }
    const touch_model_t m = model(ms, planes);
    TickInput in;
    in.device.orientation = about_y(ms % 3);
    TickOutput& out = bench.tick(ms, {0, 0, 0.01 * std::sin(ms)}, &m, {}, in);
    REQUIRE(out.force_N.allFinite());
    REQUIRE(out.torque_N_m.allFinite());
    CHECK(out.force_N.norm() <= 8 + 1e-9);
    CHECK(out.torque_N_m.norm() <= 0.3 + 1e-9);
    CHECK((out.force_N - last).norm() <= 2 + 1e-9);
    CHECK(beyond_slew_N(out.torque_N_m, last_torque, 0.075) <= 1e-9);
    last = out.force_N, last_torque = out.torque_N_m;
    CHECK(to_eigen(out.state.proxy.position_m).allFinite());
  }
}
