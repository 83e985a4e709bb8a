// Smoothness of the force of a stroke over facets. A ball tool strokes over a bumpy sphere of 20,480 triangles, with the touch model of
// the simulation (ToolTouch) and its rendering (haptic::Renderer), without a clock or a bus.
//
//    bin/stroke_table [--check] [--json FILE] [--trace FILE]
//
// The scene is the one in which CHAI3D 3.3.0 was measured: radius 100 mm, bumps of 1.5 mm up and down, 0.1 m/s, 3 mm deep, 1000 N/m,
// friction 0.3. --check: exit 1 unless, on the stroke, the force changes by at most 0.2 N per tick at p99 and by at most 0.5 N in any
// tick, and no tick of it pops through, with less than 0.05 N; and unless it changes by at most 0.5 N per tick at the first touch and the
// release, at up to 0.15 m/s ("ends max").
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sim_node/model/triangles.h"
#include "sync/node/node_options.h"
#include "tests/bench/haptic_node/stroke_loop.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/simple_hand.h"

using namespace tactus;
using bench::kStiffness_N_m;
using Eigen::Vector3d;

namespace {

constexpr double kRadius_m = 0.1, kBump_m = 0.0015, kSpeed_m_s = 0.1, kFriction = 0.3;
constexpr double kMean_N = 3;     // 3 mm at 1000 N/m
constexpr double kAir_m = 0.002;  // above the surface, at both ends

// Height of the surface over the centre, in a direction. waves: of a bump, radians per radian.
double surface_m(const Vector3d& way, double waves) {
  return kRadius_m +
         kBump_m * std::sin(waves * way.x()) * std::sin(waves * way.y() + 1) * std::sin(waves * way.z() + 2);
}

sim::WorldDef bumpy_world(int level, double tool_m, double waves) {
  sim::WorldDef w = sim::test::empty_world();
  sim::test::Soup soup = sim::test::icosphere(level, 1);
  for (Vector3d& v : soup.vertices) v *= surface_m(v.normalized(), waves);
  sim::TriangleMesh mesh{soup.vertices, {}, soup.indices};
  sim::complete_normals(mesh);
  w.meshes.push_back(mesh);
  const int body = sim::test::add_body(w, "sphere", 0, Eigen::Matrix3d::Identity(), sim::test::at(0, 0, 0));
  // A tool without a material: the friction of the pair is the geometric mean with 1.
  const int shape = sim::test::add_shape(w, body, sim::ShapeKind::kMesh, {1, 1, 1}, kFriction * kFriction);
  w.shapes[static_cast<std::size_t>(shape)].mesh = 0;
  sim::test::add_tool(w, {0, 0, 0.2}, tool_m);
  return w;
}

struct Row {
  double tool_mm = 0, rate_Hz = 0, sway_mm = 0;
  double mean_N = 0, p50_N = 0, p99_N = 0, max_N = 0, ends_max_N = 0, planes = 0;
  int ticks = 0, pops = 0;
};

struct Stroke {
  double tool_m, rate_Hz, sway_m, waves, seconds;

  // In at 0.1 m/s, around the sphere on a circle that no edge of the mesh follows, and out again.
  double ends_s() const { return (kAir_m + kMean_N / kStiffness_N_m) / kSpeed_m_s; }
  double depth_m(double t) const {
    const double end = std::min(t, seconds + 2 * ends_s() - t);
    const double part = std::clamp(end / ends_s(), 0.0, 1.0), in = part * part * (3 - 2 * part);
    const double sway = end > ends_s() ? sway_m * std::pow(std::sin(M_PI * 3 * (t - ends_s())), 2) : 0;
    return -kAir_m + in * (kAir_m + kMean_N / kStiffness_N_m) + sway;
  }
  Vector3d device(double t) const {
    const double angle = kSpeed_m_s / kRadius_m * std::clamp(t - ends_s(), 0.0, seconds);
    const Vector3d x = Vector3d(1, 0.2, -0.3).normalized(), y = x.cross(Vector3d(0.1, 0.4, 1)).normalized();
    const Vector3d way =
        (std::cos(angle) * x + std::sin(angle) * y + 0.2 * std::sin(2.3 * angle) * x.cross(y)).normalized();
    return (surface_m(way, waves) + tool_m - depth_m(t)) * way;
  }
};

double quantile(std::vector<double> x, double q) {
  if (x.empty()) return 0;
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())))];
}

Row run(const sim::WorldDef& world, sim::MeshTrees& trees, const Stroke& stroke, std::ofstream* trace) {
  haptic::Settings settings;
  settings.rate_Hz = stroke.rate_Hz;
  bench::StrokeLoop loop(world, trees, settings);

  Row row{.tool_mm = 1e3 * stroke.tool_m, .rate_Hz = stroke.rate_Hz, .sway_mm = 1e3 * stroke.sway_m};
  std::vector<double> changes;
  const double end_s = stroke.seconds + 2 * stroke.ends_s();
  const auto ticks = static_cast<std::int64_t>(end_s * stroke.rate_Hz);
  for (std::int64_t i = 0; i < ticks; ++i) {
    const double t = loop.time_s();
    const haptic::TickOutput& out = loop.tick(stroke.device(t));
    const double change = loop.change_N();
    if (trace) {
      *trace << t << ',' << out.force_N.x() << ',' << out.force_N.y() << ',' << out.force_N.z() << ',' << change;
      for (const touch_plane_t& p : loop.model().planes)
        *trace << ',' << p.contact_id << ',' << p.normal.x << ',' << p.normal.y << ',' << p.normal.z << ','
               << p.point_m.x << ',' << p.point_m.y << ',' << p.point_m.z;
      *trace << '\n';
    }
    if (t < stroke.ends_s() + 0.02 || t > end_s - stroke.ends_s()) {
      // The hand starts its sideways motion from one tick to the next when it is in: that step of the damping force is expected.
      if (t <= stroke.ends_s() || t > end_s - stroke.ends_s()) row.ends_max_N = std::max(row.ends_max_N, change);
      continue;
    }
    changes.push_back(change);
    if (out.force_N.norm() < 0.05) ++row.pops;  // the stroke is 3 mm inside everywhere
    row.mean_N += out.force_N.norm();
    row.planes += static_cast<double>(loop.model().planes.size());
  }
  row.ticks = static_cast<int>(changes.size());
  row.mean_N /= row.ticks;
  row.planes /= row.ticks;
  row.p50_N = quantile(changes, 0.5);
  row.p99_N = quantile(changes, 0.99);
  row.max_N = *std::max_element(changes.begin(), changes.end());
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  std::string json, trace_file;
  double seconds = 6, waves = 15;
  bool check = false;
  tactus::sync::Arguments app{"Smoothness of the force of a stroke over a bumpy sphere of 20,480 triangles."};
  app.add_option("--json", json, "also writes the figures to this file");
  app.add_option("--trace", trace_file, "of the first row: time, force, change, and the planes");
  app.add_option("--seconds", seconds, "of each stroke").range(0.1, 100.0);
  app.add_option("--waves", waves, "of a bump per radian").range(1.0, 40.0);
  app.add_flag("--check", check, "exit 1 unless all rows stay within the limits");
  tactus::sync::parse_or_exit(app, "stroke_table", argc, argv);
  std::printf("%8s %6s %8s %8s %10s %10s %10s %10s %6s %8s\n", "tool mm", "Hz", "sway mm", "mean N", "p50 N/tick",
              "p99 N/tick", "max N/tick", "ends max", "pops", "planes");
  nlohmann::json out = nlohmann::json::array();
  bool good = true;
  std::ofstream trace;
  if (!trace_file.empty()) trace.open(trace_file);
  for (const double tool_m : {0.005, 0.002, 0.0}) {
    const sim::WorldDef world = bumpy_world(5, tool_m, waves);
    sim::MeshTrees trees;
    for (const double sway_m : {0.0, 0.001})
      for (const double rate_Hz : {1000.0, 2000.0, 4000.0}) {
        const Row r =
            run(world, trees, {tool_m, rate_Hz, sway_m, waves, seconds}, trace.is_open() ? &trace : nullptr);
        trace.close();
        std::printf("%8g %6g %8g %8.2f %10.4f %10.4f %10.4f %10.4f %6d %8.2f\n", r.tool_mm, r.rate_Hz, r.sway_mm,
                    r.mean_N, r.p50_N, r.p99_N, r.max_N, r.ends_max_N, r.pops, r.planes);
        out.push_back({{"tool_mm", r.tool_mm},
                       {"rate_Hz", r.rate_Hz},
                       {"sway_mm", r.sway_mm},
                       {"mean_N", r.mean_N},
                       {"p50_N", r.p50_N},
                       {"p99_N", r.p99_N},
                       {"max_N", r.max_N},
                       {"ends_max_N", r.ends_max_N},
                       {"ticks", r.ticks},
                       {"pops", r.pops},
                       {"planes", r.planes}});
        // Zero force would be perfectly smooth: the check requires the mean force, to which friction adds 4 %.
        const double mean_N = kMean_N + kStiffness_N_m * sway_m / 2;
        good = good && r.p99_N <= 0.2 && r.max_N <= 0.5 && r.ends_max_N <= 0.5 && r.pops == 0 &&
               std::abs(r.mean_N - mean_N) < 0.1 * mean_N;
      }
  }
  if (!json.empty()) std::ofstream(json) << out.dump(2) << "\n";
  return check && !good ? 1 : 0;
}
