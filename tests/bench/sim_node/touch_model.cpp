// Cost of the touch model of a tool: of a ball on one fine mesh, and with many meshes in the scene; of a box, a capsule and a mesh that
// touch one mesh or lie in the corner of three.
//
//    bin/touch_model [--steps N] [--only NAME] [--json FILE]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/pose_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sim_node/touch/tool_touch.h"
#include "sim_node/model/triangles.h"
#include "sync/node/node_options.h"
#include "tests/bench/sim_node/touch_shapes.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr double kTool_m = 0.005;
constexpr int kSteps = 2000;  // steps of 1 ms

struct Scene {
  std::string name;
  WorldDef world;
  std::vector<BodyMotion> bodies;
  std::vector<Vector3d> path;  // path of the tool
  std::vector<double> us = {};
  std::size_t planes = 0;
  std::unique_ptr<Ids> ids = std::make_unique<Ids>(1);
  std::unique_ptr<ToolTouch> touch = nullptr;
};

// `count` lumpy spheres of that subdivision level on a grid, the first at the origin, with the tool stroking around it.
Scene scene_of(const std::string& name, int level, int count, bool moving) {
  Scene s{name, empty_world(), {}, {}};
  const Soup soup = lumpy_sphere(level, 0.05, 1);
  s.world.meshes.push_back({soup.vertices, {}, soup.indices});
  complete_normals(s.world.meshes.back());
  const int side = static_cast<int>(std::ceil(std::cbrt(count)));
  for (int i = 0; i < count; ++i) {
    const int body = add_body(s.world, "thing", moving ? 1 : 0, Eigen::Matrix3d::Identity(),
                              at(0.2 * (i % side), 0.2 * (i / side % side), 0.2 * (i / side / side)));
    s.world.shapes[static_cast<std::size_t>(add_shape(s.world, body, ShapeKind::kMesh, {1, 1, 1}))].mesh = 0;
  }
  const int tool = add_body(s.world, "tool", 0, Eigen::Matrix3d::Identity(), at(0, 0, 0.1));
  s.world.bodies[static_cast<std::size_t>(tool)].tool = 0;
  tool_def_t def{};
  def.body = tool;
  def.material = -1;
  def.radius_m = static_cast<float>(kTool_m);
  def.mass_kg = 0.1f;
  s.world.tools.push_back(def);
  for (const BodyDef& b : s.world.bodies) {
    BodyMotion m;
    m.position_m = m.centre_m = b.pose.translation();
    m.orientation = Eigen::Quaterniond(b.pose.linear());
    m.inverse_mass_1_kg = moving ? 1 : 0;
    s.bodies.push_back(m);
  }
  // Around the sphere at 0.2 m/s, at the distance of its surface in each direction, which the tree finds.
  const TriangleMesh& mesh = s.world.meshes[0];
  ClosestSurface surface(s.world.shapes[0], std::make_shared<const TriangleTree>(mesh.vertices, mesh.indices));
  std::vector<SurfacePlane> planes;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 0.004 * i, tilt = 0.0007 * i;
    const Vector3d way(std::cos(angle) * std::cos(tilt), std::sin(angle) * std::cos(tilt), std::sin(tilt));
    Vector3d place = 0.1 * way;
    surface.query(place, 0.1, planes);
    s.path.push_back(planes.empty() ? place : Vector3d(planes[0].point + kTool_m * planes[0].normal));
  }
  MeshTrees trees;
  s.touch = std::make_unique<ToolTouch>(s.world, 0, Settings{}, *s.ids, trees);
  return s;
}

double quantile(std::vector<double> x, double q) {
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())))];
}

}  // namespace

int main(int argc, char** argv) {
  std::string json, only;
  int steps = 200;
  tactus::sync::Arguments app{"Cost of the touch model of a tool."};
  app.add_option("--steps", steps, "steps of each row of a tool with a shape").range(1, 100'000);
  app.add_option("--only", only, "only the rows of a tool with a shape whose scene and tool contain this text, such as \"bowl.obj mesh\"");
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "touch_model", argc, argv);
  std::vector<Scene> scenes;
  scenes.push_back(scene_of("81,920 triangles, one mesh", 6, 1, false));
  for (const bool moving : {false, true})
    for (const int count : {10, 1000})
      scenes.push_back(
          scene_of("5,120 triangles, " + std::to_string(count) + (moving ? " moving meshes" : " fixed meshes"), 4,
                   count, moving));
  std::vector<contact_event_t> events;
  for (int i = 0; i < kSteps; ++i)
    for (Scene& s : scenes) {
      tool_state_t state{};
      const Vector3d p = s.path[static_cast<std::size_t>(i)];
      state.header.sim_time_ns = std::int64_t{1'000'000} * i;
      for (pose_t* pose : {&state.proxy, &state.device}) {
        pose->position_m.x = p.x(), pose->position_m.y = p.y(), pose->position_m.z = p.z();
        pose->orientation.w = 1;
      }
      events.clear();
      const auto begin = std::chrono::steady_clock::now();
      s.touch->update(sync::sim_time(state.header.sim_time_ns), s.bodies, {&state, 1}, events);
      s.us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
      s.planes += s.touch->model().planes.size();
    }
  std::printf("ball of %g mm, %d steps of 1 ms, scenes interleaved\n%-40s %10s %10s %10s\n", 1e3 * kTool_m, kSteps,
              "us", "median", "p99", "planes");
  nlohmann::json out;
  for (const Scene& s : scenes) {
    std::printf("%-40s %10.1f %10.1f %10.2f\n", s.name.c_str(), quantile(s.us, 0.5), quantile(s.us, 0.99),
                static_cast<double>(s.planes) / kSteps);
    out[s.name] = {{"median_us", quantile(s.us, 0.5)}, {"p99_us", quantile(s.us, 0.99)}};
  }
  std::printf(
      "\ntools with a shape, %d steps per row, processor time; triangles: number of triangles of the scene in the "
      "ball around the tool and its margin\n"
      "%-26s %-13s %6s %10s %10s %10s %10s\n",
      steps, "us", "tool", "m/s", "triangles", "median", "p99", "planes");
  shape_rows(TACTUS_SOURCE_DIR "/sim_node/scenes", steps, only, [&](const ShapeRow& r) {
    std::printf("%-26s %-13s %6.1f %10.0f %10.1f %10.1f %10.1f\n", r.scene.c_str(), r.tool.c_str(), r.speed_m_s, r.triangles,
                r.median_us, r.p99_us, r.planes);
    std::fflush(stdout);
    out["shapes"].push_back({{"scene", r.scene},
                             {"tool", r.tool},
                             {"speed_m_s", r.speed_m_s},
                             {"triangles", r.triangles},
                             {"planes", r.planes},
                             {"median_us", r.median_us},
                             {"p99_us", r.p99_us}});
  });
  if (!json.empty()) std::ofstream(json) << out.dump(2) << "\n";
  return 0;
}
