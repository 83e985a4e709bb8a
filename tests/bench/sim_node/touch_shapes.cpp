// Scenes and measurement of the touch model of tools with a shape.
#include "lcmtypes/turn_between.h"
#include "tests/bench/sim_node/touch_shapes.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <tactus/contact_event_t.hpp>
#include <tactus/pose_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sim_node/touch/tool_touch.h"
#include "sim_node/scene/meshes/mesh_file.h"
#include "sim_node/model/tool_shape.h"
#include "sim_node/model/triangles.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/simple_hand.h"

namespace tactus::sim::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMargin_m = 0.003;  // margin of a tool with a shape over meshes, at rest
constexpr double kGap_m = 0.00015;   // gap of the tool at the start: the skin and a little more

struct ToolCase {
  std::string name;
  std::int8_t shape;
  Vector3d size_m;
  TriangleMesh mesh;  // for the shape "mesh"
};

struct SceneCase {
  std::string name;
  std::vector<TriangleMesh> meshes;  // one per body
  Vector3d from;                     // position of the tool at the beginning of the first step
  std::vector<Vector3d> ways;        // directions in which it approaches, one after the other
  bool strokes = false;              // around the origin, once in a thousand steps
  std::vector<double> speeds_m_s{0};
};

TriangleMesh mesh_of(const Soup& soup) {
  TriangleMesh m{soup.vertices, {}, soup.indices};
  complete_normals(m);
  return m;
}

Eigen::Isometry3d facing(const Vector3d& way, const Vector3d& place) {
  Eigen::Isometry3d p(turn_between(Vector3d::UnitZ(), way));
  p.translation() = place;
  return p;
}

Soup fine_box(const Vector3d& size, int n) {
  Soup s;
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Isometry3d to = facing(side * Vector3d::Unit(k), 0.5 * side * size[k] * Vector3d::Unit(k));
      const Vector3d across = (to.linear().transpose() * size).cwiseAbs();
      s.add(plate(across.x(), across.y(), n, n), to);
    }
  return s;
}

std::vector<ToolCase> tools() {
  const Vector3d size(0.03, 0.02, 0.012);
  return {{"box", tool_def_t::BOX, size, {}},
          {"capsule", tool_def_t::CAPSULE, {0.006, 0, 0.02}, {}},
          {"mesh 320", tool_def_t::MESH, {0, 0, 0}, mesh_of(lumpy_sphere(2, 0.012, 2))},
          {"mesh 1280", tool_def_t::MESH, {0, 0, 0}, mesh_of(lumpy_sphere(3, 0.012, 2))},
          {"fine box 972", tool_def_t::MESH, {0, 0, 0}, mesh_of(fine_box(size, 9))}};
}

std::vector<SceneCase> scenes_of(const std::string& folder) {
  const auto file = [&](const char* name) { return read_mesh(folder + name, "", false, {1, 1, 1}); };
  std::vector<SceneCase> all;
  for (const int level : {3, 4, 5, 6}) {
    SceneCase s{"lumpy sphere", {mesh_of(lumpy_sphere(level, 0.05, 1))}, {0.09, 0, 0}, {-Vector3d::UnitX()}, true};
    if (level >= 5) s.speeds_m_s = {0, 0.2};
    all.push_back(std::move(s));
  }
  all.push_back({"bumpy_sphere.obj", {file("/bumpy_sphere.obj")}, {0.2, 0, 0}, {-Vector3d::UnitX()}, true});
  all.push_back({"bowl.obj", {file("/bowl.obj")}, {0, 0, 0.15}, {-Vector3d::UnitZ()}, false});
  const TriangleMesh flat = mesh_of(plate(0.2, 0.2, 58, 58));
  SceneCase corner{"corner of three", {}, {0.03, 0.03, 0.03}, {}, false, {0, 0.2}};
  for (int k = 0; k < 3; ++k) {
    TriangleMesh m = flat;
    for (Vector3d& v : m.vertices) v = facing(Vector3d::Unit(k), {0, 0, 0}) * v;
    corner.meshes.push_back(m);
  }
  for (int round = 0; round < 3; ++round)
    for (int k = 0; k < 3; ++k) corner.ways.push_back(-Vector3d::Unit(k));
  all.push_back(std::move(corner));
  return all;
}

SceneCase hole(const std::string& folder) {
  return {"hole_plate.obj",
          {read_mesh(folder + "/hole_plate.obj", "", false, {1, 1, 1})},
          {0.0002, 0, 0.02},
          {},
          false,
          {0, 0.2}};
}

// Time of this thread; other programs are not counted.
double processor_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> x, double q) {
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())))];
}

class Bench {
 public:
  Bench(const SceneCase& scene, const ToolCase& tool) : scene_(scene), world_(empty_world()) {
    for (const TriangleMesh& m : scene.meshes) {
      const int body = add_body(world_, "thing", 0, Eigen::Matrix3d::Identity(), at(0, 0, 0));
      world_.shapes[static_cast<std::size_t>(add_shape(world_, body, ShapeKind::kMesh, {1, 1, 1}))].mesh =
          static_cast<int>(world_.meshes.size());
      world_.meshes.push_back(m);
      trees_of_.emplace_back(m.vertices, m.indices);
    }
    add_tool(world_, scene.from);
    tool_def_t& t = world_.tools.back();
    t.shape = tool.shape;
    t.size_m = to_vec3(tool.size_m);
    if (tool.shape == tool_def_t::MESH) {
      t.mesh_hash = static_cast<std::int64_t>(world_.meshes.size());
      world_.meshes.push_back(tool.mesh);
    }
    t.radius_m = static_cast<float>(bound_m(world_, tool_shape(t)));
    bound_m_ = t.radius_m;
    for (const BodyDef& b : world_.bodies) {
      BodyMotion m;
      m.position_m = m.centre_m = b.pose.translation();
      bodies_.push_back(m);
    }
  }

  ShapeRow run(int steps, double speed_m_s) {
    ToolTouch probe(world_, 0, Settings{}, ids_, trees_), touch(world_, 0, Settings{}, ids_, trees_);
    ShapeRow row;
    row.speed_m_s = speed_m_s;
    std::vector<double> us;
    std::vector<contact_event_t> events;
    for (int i = 0; i < steps; ++i) {
      tool_state_t m = come_near(i, probe);
      m.device_velocity_m_s.y = static_cast<float>(speed_m_s);
      events.clear();
      const double begin = processor_us();
      touch.update(sync::sim_time(m.header.sim_time_ns), bodies_, {&m, 1}, events);
      us.push_back(processor_us() - begin);
      row.planes += static_cast<double>(touch.model().planes.size()) / steps;
      std::vector<NearTriangle> near;
      for (const TriangleTree& tree : trees_of_) {
        tree.near(to_eigen(m.proxy.position_m), bound_m_ + kMargin_m, 1'000'000, near);
        row.triangles += static_cast<double>(near.size()) / steps;
      }
    }
    row.median_us = quantile(us, 0.5);
    row.p99_us = quantile(us, 0.99);
    return row;
  }

 private:
  // The tool of that step, moved closer until it touches; it rotates a little with each step.
  tool_state_t come_near(int step, ToolTouch& probe) {
    tool_state_t m{};
    m.header.sim_time_ns = std::int64_t{1'000'000} * step;
    const Quaterniond around(Eigen::AngleAxisd(scene_.strokes ? 2e-3 * M_PI * step : 0, Vector3d(0, 0.28, 0.96)));
    const Quaterniond turn =
        around * Quaterniond(Eigen::AngleAxisd(0.004 * std::sin(0.05 * step), Vector3d(0.6, 0, 0.8)));
    Vector3d place = around * scene_.from;
    const auto put = [&] {
      for (pose_t* pose : {&m.proxy, &m.device})
        pose->position_m = to_vec3(place), pose->orientation = to_quat(turn);
    };
    put();
    for (const Vector3d& way : scene_.ways)
      for (int k = 0; k < 60; ++k) {
        probe.update_at_rest(sync::sim_time(m.header.sim_time_ns), bodies_, {&m, 1});
        double gap = kMargin_m;
        for (const touch_plane_t& p : probe.model().planes) {
          const Vector3d n = to_eigen(p.normal);
          if (n.dot(around * way) > -0.3) continue;
          gap = std::min(gap, n.dot(place + turn * to_eigen(p.tool_point_m) - to_eigen(p.point_m)));
        }
        if (gap <= 1.2 * kGap_m) break;
        place += (gap - kGap_m) * (around * way);
        put();
      }
    return m;
  }

  const SceneCase& scene_;
  WorldDef world_;
  std::vector<BodyMotion> bodies_;
  std::vector<TriangleTree> trees_of_;
  MeshTrees trees_;
  Ids ids_{1};
  double bound_m_ = 0;
};

void run(const SceneCase& scene, const ToolCase& tool, int steps,
         const std::function<void(const ShapeRow&)>& done) {
  std::size_t triangles = 0;
  for (const TriangleMesh& m : scene.meshes) triangles += m.indices.size() / 3;
  for (const double speed : scene.speeds_m_s) {
    ShapeRow row = Bench(scene, tool).run(steps, speed);
    row.scene = scene.name + ", " + std::to_string(triangles);
    row.tool = tool.name;
    done(row);
  }
}

}  // namespace

void shape_rows(const std::string& scenes, int steps, const std::string& only,
                const std::function<void(const ShapeRow&)>& done) {
  for (const SceneCase& scene : scenes_of(scenes))
    for (const ToolCase& tool : tools())
      if ((scene.name + " " + tool.name).find(only) != std::string::npos) run(scene, tool, steps, done);
  if (std::string("hole_plate.obj peg.obj").find(only) == std::string::npos) return;
  run(hole(scenes), {"peg.obj", tool_def_t::MESH, {0, 0, 0}, read_mesh(scenes + "/peg.obj", "", false, {1, 1, 1})},
      steps, done);
}

}  // namespace tactus::sim::test
