// Board, mesh and hand of the stroke over planks.png.
#include "tests/bench/haptic_node/bump_stroke.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <tactus/material_def_t.hpp>

#include "lcmtypes/relief.h"
#include "sim_node/model/triangles.h"
#include "sync/pictures/confined_pictures.h"
#include "tests/bench/haptic_node/stroke_loop.h"
#include "tests/sim_node/support/simple_hand.h"

namespace tactus::bench {
namespace {

using Eigen::Vector3d;

constexpr double kTile_m = 0.08;   // one repetition, as in bump_plane.sdf
constexpr double kEnds_s = 0.15;   // the hand enters and the force settles; not counted
constexpr double kStart_s = 0.05;  // the hand starts to move and the damper responds; not counted either

const HeightMap& planks() {
  static const HeightMap map = [] {
    std::ifstream file(TACTUS_SOURCE_DIR "/sim_node/scenes/planks.png", std::ios::binary);
    return sync::ConfinedPictures().height_map(std::vector<std::uint8_t>(std::istreambuf_iterator<char>(file), {}));
  }();
  return map;
}

material_def_t material(double height_m) {
  material_def_t m{};
  m.name = "planks";
  m.youngs_modulus_Pa = 1e10, m.poissons_ratio = 0.3, m.friction_static = m.friction_dynamic = 1;
  m.bump_asset = 1, m.bump_size_u_m = m.bump_size_v_m = kTile_m, m.bump_height_m = height_m;
  return m;
}

// The heights of the map at the centres of its pixels, joined by triangles, without a filter.
sim::TriangleMesh mesh_of(const BumpStroke& s) {
  const HeightMap& map = planks();
  const double pixel = kTile_m / map.columns;
  const int first = static_cast<int>(std::floor(-0.02 / pixel)),
            last = static_cast<int>(std::ceil((s.length_m + 0.01) / pixel));
  const auto u_of = [&](int row) { return s.lateral_m + s.oblique * row * pixel; };
  sim::TriangleMesh mesh;
  constexpr int kHalf = 8;  // pixels to each side of the stroke
  const auto wrapped = [](int i, int n) { return ((i % n) + n) % n; };
  for (int row = first; row <= last; ++row) {
    const int middle = static_cast<int>(std::floor(u_of(row) / pixel));
    for (int c = -kHalf; c <= kHalf; ++c) {
      const int column = middle + c;
      mesh.vertices.emplace_back((column + 0.5) * pixel, (row + 0.5) * pixel,
                                 s.height_m * map.at(wrapped(column, map.columns), wrapped(row, map.rows)));
    }
  }
  constexpr int kWide = 2 * kHalf + 1;
  for (int r = 0; r < last - first; ++r) {
    // The strip follows the stroke: the next row may begin one pixel further.
    const auto at = [&](int row, int column) { return row * kWide + column; };
    const int shift = static_cast<int>(std::lround((mesh.vertices[static_cast<std::size_t>(at(r + 1, 0))].x() -
                                                    mesh.vertices[static_cast<std::size_t>(at(r, 0))].x()) /
                                                   pixel));
    for (int c = std::max(0, shift); c + 1 < kWide + std::min(0, shift); ++c) {
      const int a = at(r, c), b = at(r, c + 1), d = at(r + 1, c - shift), e = at(r + 1, c + 1 - shift);
      for (const int i : {a, b, e, a, e, d}) mesh.indices.push_back(i);
    }
  }
  sim::complete_normals(mesh);
  return mesh;
}

sim::WorldDef world_of(const BumpStroke& s) {
  sim::WorldDef w = sim::test::empty_world(0);
  w.materials = {material(s.height_m)};
  if (s.method == "mesh") w.materials[0].bump_asset = 0;
  const int body = sim::test::add_body(w, "board", 0, Eigen::Matrix3d::Identity(), Eigen::Isometry3d::Identity());
  // A tool without a material: the friction of the pair is the geometric mean with 1.
  const double friction = s.friction * s.friction;
  int shape = 0;
  if (s.method == "mesh") {
    w.meshes.push_back(mesh_of(s));
    shape = sim::test::add_shape(w, body, sim::ShapeKind::kMesh, {1, 1, 1}, friction);
    w.shapes[static_cast<std::size_t>(shape)].mesh = 0;
  } else {
    shape = sim::test::add_shape(w, body, sim::ShapeKind::kBox, {4, 4, 0.02}, friction);
    w.shapes[static_cast<std::size_t>(shape)].pose.translation().z() = -0.01;
  }
  w.shapes[static_cast<std::size_t>(shape)].material = 0;
  sim::test::add_tool(w, {0, 0, 0.05}, 0);
  return w;
}

}  // namespace

BumpTrace run(const BumpStroke& stroke) {
  const sim::WorldDef world = world_of(stroke);
  sim::MeshTrees trees;
  haptic::Settings settings;
  settings.rate_Hz = stroke.rate_Hz;
  settings.bump = stroke.method == "mesh" ? "none" : stroke.method;
  StrokeLoop loop(world, trees, settings);
  const material_def_t wears = material(stroke.height_m);
  const auto relief = std::make_shared<const Relief>(make_relief(planks(), wears));
  auto maps = std::make_shared<haptic::SurfaceMaps>();
  maps->by_material.push_back({relief, nullptr});
  loop.renderer().set_maps(maps);

  const Vector3d along = Vector3d(stroke.oblique, 1, 0).normalized();
  const double high = 0.01 + stroke.height_m;
  const auto device = [&](double t) {
    const double in = std::clamp(t / (kEnds_s / 2), 0.0, 1.0), eased = in * in * (3 - 2 * in);
    const double way = stroke.speed_m_s * (t - kEnds_s);
    return Vector3d(Vector3d(stroke.lateral_m, 0, high * (1 - eased) - stroke.depth_m * eased) +
                    std::max(0.0, way) * along);
  };

  BumpTrace out;
  Vector3d force_N = Vector3d::Zero();
  out.step_m = stroke.speed_m_s / stroke.rate_Hz;
  const double end_s = kEnds_s + stroke.length_m / along.y() / stroke.speed_m_s;
  const auto ticks = static_cast<std::int64_t>(end_s * stroke.rate_Hz);
  for (std::int64_t i = 0; i < ticks; ++i) {
    const double t = loop.time_s();
    const Vector3d at = device(t), last_N = force_N;
    const haptic::TickOutput& tick = loop.tick(at);
    force_N = tick.force_N;
    if (t < kEnds_s + kStart_s) continue;
    out.position_m.push_back(stroke.speed_m_s * (t - kEnds_s));
    out.along_N.push_back(tick.force_N.dot(along));
    out.up_N.push_back(tick.force_N.z());
    out.slope.push_back(relief->slope(bump_at(relief->size_m, {2, 0, 1}, at)).dot(along.head<2>()));
    out.proxy_m.push_back(tick.state.proxy.position_m.z);
    out.change_N.push_back(loop.change_N());
    const double size = tick.force_N.norm();
    out.rise_N.push_back(size > 0 ? size - std::max(0.0, last_N.dot(tick.force_N) / size) : 0);
  }
  return out;
}

}  // namespace tactus::bench
