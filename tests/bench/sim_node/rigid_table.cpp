// Accuracy and smoothness of touch with six degrees of freedom: a box and a capsule in the hand, with the touch model of the simulation
// and its rendering, without a clock or a bus.
//
//    bin/rigid_table [--check] [--json FILE] [--seconds S]
//
// pressed: a box on a floor, 2.5 mm deep and slightly rotated, against springs in closed form. pushed: a free body pushed off its centre;
// its momentum against the opposite of the impulse on the hand. thin: a plate of 2 mm that the hand passes through and the box does not.
// between: a body between the box and a wall. hole: a peg, a mesh, inserted into its hole by a virtual hand that is 1 mm and 3 degrees
// off. stroke: over the bumpy sphere of stroke_table; change of force and torque per tick. --check: exit 1 when a row exceeds its limit.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/devices/virtual_hand.h"
#include "haptic_node/rendering/rigid_coupling.h"
#include "sim_node/scene/meshes/mesh_file.h"
#include "sim_node/model/tool_shape.h"
#include "sim_node/model/triangles.h"
#include "sync/node/node_options.h"
#include "tests/bench/haptic_node/touch_loop.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/simple_hand.h"

using namespace tactus;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::TouchLoop;

namespace {

using Figures = std::vector<std::pair<std::string, double>>;

// A tool touches from this distance on.
constexpr double kSkin_m = sim::ShapeSearch::kSkin_m;

struct Report {
  nlohmann::json out = nlohmann::json::array();
  bool good = true;

  void row(const std::string& name, const Figures& figures, bool within) {
    std::printf("%-28s", name.c_str());
    nlohmann::json j{{"row", name}, {"within", within}};
    for (const auto& [what, value] : figures) {
      std::printf("  %s %.4g", what.c_str(), value);
      j[what] = value;
    }
    std::printf("%s\n", within ? "" : "  OUT OF BOUNDS");
    std::fflush(stdout);
    out.push_back(j);
    good = good && within;
  }
};

sim::WorldDef& add_shaped_tool(sim::WorldDef& w, std::int8_t shape, const Vector3d& size, const Vector3d& place,
                               int mesh = 0) {
  sim::test::add_tool(w, place);
  tool_def_t& t = w.tools.back();
  t.shape = shape;
  t.size_m = to_vec3(size);
  t.mesh_hash = mesh;
  t.radius_m = sim::bound_m(w, sim::tool_shape(t));
  return w;
}

haptic::Settings at_rate(double rate_Hz) {
  haptic::Settings s;
  s.rate_Hz = rate_Hz;
  return s;
}

Quaterniond about(const Vector3d& axis, double rad) { return Quaterniond(Eigen::AngleAxisd(rad, axis)); }

void pressed(Report& report, double rate_Hz) {
  sim::WorldDef w = sim::test::empty_world();
  sim::test::add_floor(w);
  add_shaped_tool(w, tool_def_t::BOX, {0.04, 0.06, 0.02}, {0, 0, 0.02});
  const haptic::Settings settings = at_rate(rate_Hz);
  TouchLoop loop(w, settings);
  const double depth_m = 0.0025, turn_rad = 0.01;
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (int i = 0; i < static_cast<int>(rate_Hz); ++i) {
    const double in = std::min(1.0, loop.time_s() / 0.3);
    const auto& out = loop.tick({0, 0, 0.02 - in * (0.01 - kSkin_m + depth_m)},
                                about(Vector3d(1, 2, 0).normalized(), in * turn_rad));
    force = out.force_N, torque = out.torque_N_m;
  }
  const haptic::CouplingLimits limits{settings.stiffness_limit_N_m, settings.mass_factor, settings.damping_ratio,
                                      settings.device_mass_kg, settings.device_damping_Ns_m};
  const touch_plane_t& plane = loop.model().planes.at(0);
  const double k =
      haptic::coupling_gains(plane.stiffness_N_m, plane.damping_N_s_m, 1e10, 1, 1 / rate_Hz, limits).stiffness_N_m;
  const double lever = haptic::coupling_lever_m(settings);
  const Vector3d expected = -k * lever * lever * turn_rad * Vector3d(1, 2, 0).normalized();
  const double force_error = std::abs(force.z() / (k * depth_m) - 1),
               torque_error = (torque - expected).norm() / expected.norm();
  report.row("pressed " + std::to_string(static_cast<int>(rate_Hz)) + " Hz",
             {{"N", force.z()},
              {"of_N", k * depth_m},
              {"N_m", torque.norm()},
              {"of_N_m", expected.norm()},
              {"planes", static_cast<double>(loop.model().planes.size())}},
             force_error < 1e-3 && torque_error < 1e-2);
}

void pushed(Report& report, double rate_Hz) {
  sim::WorldDef w = sim::test::empty_world(0);
  const Vector3d size(0.06, 0.1, 0.04);
  const int box = sim::test::add_box(w, 0.4, size, sim::test::at(0.05, 0.03, 0));
  add_shaped_tool(w, tool_def_t::BOX, {0.02, 0.02, 0.02}, {0, 0, 0});
  TouchLoop loop(w, at_rate(rate_Hz));
  Vector3d impulse = Vector3d::Zero(), moment = Vector3d::Zero();
  // Contact for 0.3 s, then away, so that all energy on the way has been delivered.
  for (int i = 0; i < static_cast<int>(rate_Hz); ++i) {
    const double t = loop.time_s();
    const double x = t < 0.3 ? 0.05 * t : 0.015 - 0.1 * (t - 0.3);
    const auto& out = loop.tick({x, 0, 0}, Quaterniond::Identity());
    const sim::BodyMotion& b = loop.world().bodies()[static_cast<std::size_t>(box)];
    const Vector3d proxy = to_eigen(out.state.proxy.position_m);
    impulse -= out.force_N / rate_Hz;
    moment -= (out.torque_N_m + (proxy - b.centre_m).cross(out.force_N)) / rate_Hz;
  }
  const sim::BodyMotion& b = loop.world().bodies()[static_cast<std::size_t>(box)];
  const Vector3d momentum = b.velocity_m_s / b.inverse_mass_1_kg,
                 spin = b.inverse_inertia.inverse() * b.spin_rad_s;
  const double of_impulse = (momentum - impulse).norm() / impulse.norm(),
               of_moment = (spin - moment).norm() / moment.norm();
  report.row("pushed " + std::to_string(static_cast<int>(rate_Hz)) + " Hz",
             {{"N_s", impulse.norm()},
              {"off", of_impulse},
              {"N_m_s", moment.norm()},
              {"off_turning", of_moment},
              {"rad_s", b.spin_rad_s.norm()}},
             of_impulse < 0.01 && of_moment < 0.03 && b.spin_rad_s.norm() > 0.05);
}

void thin(Report& report, double rate_Hz) {
  sim::WorldDef w = sim::test::empty_world();
  const int plate = sim::test::add_body(w, "plate", 0, Eigen::Matrix3d::Identity(), sim::test::at(0, 0, 0));
  sim::test::add_shape(w, plate, sim::ShapeKind::kBox, {0.3, 0.3, 0.002});
  add_shaped_tool(w, tool_def_t::BOX, {0.04, 0.03, 0.02}, {0, 0, 0.04});
  TouchLoop loop(w, at_rate(rate_Hz));
  double lowest = 1;
  for (int i = 0; i < static_cast<int>(rate_Hz); ++i) {
    const double z = 0.04 - 0.5 * std::min(loop.time_s(), 0.2);
    const auto& out = loop.tick({0.01 * std::sin(20 * loop.time_s()), 0, z},
                                about({0.6, 0.8, 0}, 0.3 * std::sin(30 * loop.time_s())));
    const Eigen::Isometry3d pose = to_eigen(out.state.proxy);
    for (int c = 0; c < 8; ++c)
      lowest = std::min(lowest,
                        (pose * Vector3d(c & 1 ? 0.02 : -0.02, c & 2 ? 0.015 : -0.015, c & 4 ? 0.01 : -0.01)).z());
  }
  report.row("thin " + std::to_string(static_cast<int>(rate_Hz)) + " Hz", {{"mm_in", 1e3 * (0.001 - lowest)}},
             lowest > 0.0005);
}

void between(Report& report) {
  sim::WorldDef w = sim::test::empty_world(0);
  const int wall = sim::test::add_body(w, "wall", 0, Eigen::Matrix3d::Identity(), sim::test::at(0.1, 0, 0));
  sim::test::add_shape(w, wall, sim::ShapeKind::kBox, {0.004, 0.3, 0.3});
  const int body = sim::test::add_box(w, 0.2, {0.03, 0.05, 0.05}, sim::test::at(0.07, 0, 0));
  add_shaped_tool(w, tool_def_t::BOX, {0.02, 0.03, 0.03}, {0, 0, 0});
  TouchLoop loop(w, at_rate(1000));
  double furthest = 0, into = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto& out = loop.tick({std::min(0.2, 0.1 * loop.time_s()), 0.003, 0}, Quaterniond::Identity());
    const double x = loop.world().bodies()[static_cast<std::size_t>(body)].position_m.x();
    furthest = std::max(furthest, x + 0.015 - 0.098);
    into = std::max(into, out.state.proxy.position_m.x + 0.01 - (x - 0.015));
  }
  report.row("between", {{"mm_in_wall", 1e3 * furthest}, {"mm_in_body", 1e3 * into}},
             furthest < 0.001 && into < 0.001);
}

void hole(Report& report, const std::string& scenes, double rate_Hz) {
  sim::WorldDef w = sim::test::empty_world();
  w.meshes.push_back(sim::read_mesh(scenes + "/peg.obj", "", false, {1, 1, 1}));
  w.meshes.push_back(sim::read_mesh(scenes + "/hole_plate.obj", "", false, {1, 1, 1}));
  const int plate = sim::test::add_body(w, "plate", 0, Eigen::Matrix3d::Identity(), sim::test::at(0, 0, 0));
  const int shape = sim::test::add_shape(w, plate, sim::ShapeKind::kMesh, {1, 1, 1}, 0.04);
  w.shapes[static_cast<std::size_t>(shape)].mesh = 1;
  const Eigen::AlignedBox3d peg = sim::bounds(w.meshes[0], Eigen::Isometry3d::Identity()),
                            around = sim::bounds(w.meshes[1], Eigen::Isometry3d::Identity());
  const double above = around.max().z() - peg.min().z() + 0.005;
  add_shaped_tool(w, tool_def_t::MESH, {0, 0, 0}, {0, 0, above}, 0);
  haptic::Settings settings = at_rate(rate_Hz);
  TouchLoop loop(w, settings);
  const double down = 0.02;
  haptic::VirtualHand hand(
      haptic::MonotoneCubic({0, 0.2, 2}, {{0.001, 0, above}, {0.001, 0, above}, {0.001, 0, above - 0.005 - down}},
                            haptic::MonotoneCubic::Ends::kRest),
      false, {}, about(Vector3d::UnitY(), 3 * M_PI / 180));
  hand.begin(sync::host_time(0));
  double max_N = 0, max_N_m = 0, max_change = 0, z = 0;
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < static_cast<int>(3 * rate_Hz); ++i) {
    const auto& out = loop.tick(hand.read(sync::host_time(std::llround(1e9 * loop.time_s()))));
    hand.write(haptic::Wrench{out.force_N, out.torque_N_m});
    max_N = std::max(max_N, out.force_N.norm());
    max_N_m = std::max(max_N_m, out.torque_N_m.norm());
    max_change = std::max(max_change, (out.force_N - last).norm());
    last = out.force_N;
    z = out.state.proxy.position_m.z;
  }
  const double depth = above - 0.005 - z;
  report.row("hole " + std::to_string(static_cast<int>(rate_Hz)) + " Hz",
             {{"mm_deep", 1e3 * depth},
              {"of_mm", 1e3 * down},
              {"N_max", max_N},
              {"N_m_max", max_N_m},
              {"N_a_tick", max_change}},
             depth > 0.8 * down);
}

// The values of stroke_table.
constexpr double kRadius_m = 0.1, kBump_m = 0.0015, kSpeed_m_s = 0.1, kFriction = 0.3, kDeep_m = 0.003;
double surface_m(const Vector3d& way, double waves) {
  return kRadius_m +
         kBump_m * std::sin(waves * way.x()) * std::sin(waves * way.y() + 1) * std::sin(waves * way.z() + 2);
}

void stroke(Report& report, std::int8_t shape, double rate_Hz, double seconds) {
  constexpr double kWaves = 15;
  sim::WorldDef w = sim::test::empty_world();
  sim::test::Soup soup = sim::test::icosphere(5, 1);
  for (Vector3d& v : soup.vertices) v *= surface_m(v.normalized(), kWaves);
  sim::TriangleMesh mesh{soup.vertices, {}, soup.indices};
  sim::complete_normals(mesh);
  w.meshes.push_back(mesh);
  const int body = sim::test::add_body(w, "sphere", 0, Eigen::Matrix3d::Identity(), sim::test::at(0, 0, 0));
  const int s = sim::test::add_shape(w, body, sim::ShapeKind::kMesh, {1, 1, 1}, kFriction * kFriction);
  w.shapes[static_cast<std::size_t>(s)].mesh = 0;
  const bool box = shape == tool_def_t::BOX;
  add_shaped_tool(w, shape, box ? Vector3d(0.02, 0.02, 0.01) : Vector3d(0.005, 0, 0.03), {0, 0, 0.2});
  sim::Settings of_sim;
  of_sim.touch_stiffness_N_m = 1000;
  TouchLoop loop(w, at_rate(rate_Hz), of_sim);
  const double ends_s = 0.1, half_m = 0.005;
  const Vector3d x = Vector3d(1, 0.2, -0.3).normalized(), y = x.cross(Vector3d(0.1, 0.4, 1)).normalized();
  std::vector<double> force_changes, torque_changes;
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  double mean_N = 0, planes = 0;
  int pops = 0;
  for (int i = 0; i < static_cast<int>((seconds + ends_s) * rate_Hz); ++i) {
    const double t = loop.time_s(), in = std::min(1.0, t / ends_s);
    const double angle = kSpeed_m_s / kRadius_m * std::max(0.0, t - ends_s);
    const Vector3d way =
        (std::cos(angle) * x + std::sin(angle) * y + 0.2 * std::sin(2.3 * angle) * x.cross(y)).normalized();
    // The box lies flat to the sphere; the capsule across the stroke.
    Eigen::Matrix3d turn;
    turn.col(box ? 2 : 0) = way;
    turn.col(box ? 0 : 2) = x.cross(y).cross(way).cross(way).normalized();
    turn.col(1) = turn.col(2).cross(turn.col(0));
    const double height = surface_m(way, kWaves) + half_m + 0.003 - in * in * (3 - 2 * in) * (0.003 + kDeep_m);
    const auto& out = loop.tick(height * way, Quaterniond(turn));
    const double change = (out.force_N - force).norm(), turned = (out.torque_N_m - torque).norm();
    force = out.force_N, torque = out.torque_N_m;
    if (t < ends_s + 0.05) continue;
    force_changes.push_back(change), torque_changes.push_back(turned);
    mean_N += force.norm(), planes += static_cast<double>(loop.model().planes.size());
    pops += force.norm() < 0.05;
  }
  const auto quantile = [](std::vector<double> v, double q) {
    std::sort(v.begin(), v.end());
    return v[std::min(v.size() - 1, static_cast<std::size_t>(q * static_cast<double>(v.size())))];
  };
  const double count = static_cast<double>(force_changes.size()), p99 = quantile(force_changes, 0.99),
               most = quantile(force_changes, 1);
  report.row(
      std::string("stroke ") + (box ? "box " : "capsule ") + std::to_string(static_cast<int>(rate_Hz)) + " Hz",
      {{"mean_N", mean_N / count},
       {"p99_N", p99},
       {"max_N", most},
       {"p99_N_m", quantile(torque_changes, 0.99)},
       {"max_N_m", quantile(torque_changes, 1)},
       {"pops", static_cast<double>(pops)},
       {"planes", planes / count}},
      p99 <= 0.2 && most <= 0.5 && pops == 0);
}

}  // namespace

int main(int argc, char** argv) {
  std::string json, only;
  double seconds = 3;
  bool check = false;
  tactus::sync::Arguments app{"Accuracy and smoothness of touch with six degrees of freedom."};
  app.add_option("--json", json, "also writes the figures to this file");
  app.add_option("--seconds", seconds, "of each stroke").range(0.1, 100.0);
  app.add_option("--only", only, "only the rows of this name: pressed, pushed, thin, between, hole or stroke");
  app.add_flag("--check", check, "exit 1 unless all rows stay within the limits");
  tactus::sync::parse_or_exit(app, "rigid_table", argc, argv);
  Report report;
  const auto selected = [&](const std::string& name) { return only.empty() || only == name; };
  for (const double rate_Hz : {1000.0, 2000.0, 4000.0}) {
    if (selected("pressed")) pressed(report, rate_Hz);
    if (selected("pushed")) pushed(report, rate_Hz);
    if (selected("thin")) thin(report, rate_Hz);
    if (selected("hole")) hole(report, TACTUS_SOURCE_DIR "/sim_node/scenes", rate_Hz);
    if (selected("stroke")) stroke(report, tool_def_t::BOX, rate_Hz, seconds);
    if (selected("stroke")) stroke(report, tool_def_t::CAPSULE, rate_Hz, seconds);
  }
  if (selected("between")) between(report);
  if (!json.empty()) std::ofstream(json) << report.out.dump(2) << "\n";
  return check && !report.good ? 1 : 0;
}
