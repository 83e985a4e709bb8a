// Cost of finding contacts and their gaps: each pair of shapes compared with ODE's dCollide and FCL's distance, and a whole scene of boxes
// compared with ODE's dSpaceCollide. Medians of interleaved runs, microseconds.
//
//    bin/gaps_bench [--json FILE]
#include <ode/ode.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "sim_node/contacts/contact_finder.h"
#include "sync/node/node_options.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0 : v[v.size() / 2];
}

template <class Action>
double us(Action&& what) {
  const auto before = std::chrono::steady_clock::now();
  what();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count();
}

struct NamedShape {
  const char* name;
  ShapeDef def;
};

ShapeDef shape(ShapeKind kind, const Vector3d& size) {
  ShapeDef s;
  s.kind = kind;
  s.size_m = size;
  s.mesh = kind == ShapeKind::kMesh ? 0 : -1;
  return s;
}

// A pose for b at which its least gap to a has the given value, by bisection along a random direction.
Isometry3d at_gap(Detector& gaps, int a, int b, double gap, Random& random) {
  Isometry3d pose = random_pose(random, 0);
  Vector3d way = direction(random);
  way.z() = std::abs(way.z());
  double near = 0.02, far = 0.5;
  std::vector<PointPair> found;
  for (int i = 0; i < 40; ++i) {
    const double at = (near + far) / 2;
    pose.translation() = at * way;
    gaps.query(a, Isometry3d::Identity(), b, pose, 0.01, found);
    double least = 1;
    for (const PointPair& p : found) least = std::min(least, p.gap_m);
    (least > gap ? far : near) = at;
  }
  return pose;
}

void pairs(nlohmann::json& json) {
  const NamedShape kinds[] = {{"plane", shape(ShapeKind::kPlane, {1, 1, 1})},
                         {"ball", shape(ShapeKind::kSphere, {0.05, 0, 0})},
                         {"box", shape(ShapeKind::kBox, {0.1, 0.08, 0.12})},
                         {"capsule", shape(ShapeKind::kCapsule, {0.04, 0, 0.1})},
                         {"cylinder", shape(ShapeKind::kCylinder, {0.05, 0, 0.1})},
                         {"mesh", shape(ShapeKind::kMesh, {1, 1, 1})}};
  WorldDef world;
  const Soup lumpy = lumpy_sphere(4, 0.08, 3);
  world.meshes = {{lumpy.vertices, {}, lumpy.indices}};
  std::printf("%-22s %10s %10s %10s %10s   us; a mesh has 5,120 triangles\n", "pair", "gap 0.2 mm", "overlap 5um",
              "ODE overlap", "FCL gap");
  for (std::size_t i = 0; i < std::size(kinds); ++i)
    for (std::size_t j = i; j < std::size(kinds); ++j) {
      const ShapeKind a = kinds[i].def.kind, b = kinds[j].def.kind;
      auto gaps = make_detector("gaps"), ode = make_detector("ode");
      auto fcl = make_fcl_detector();
      if (!gaps->unsupported_reason(a, b).empty()) continue;
      if (fcl && !fcl->unsupported_reason(a, b).empty()) fcl = nullptr;
      for (Detector* d : {gaps.get(), ode.get(), fcl.get()})
        if (d) d->add(kinds[i].def, world), d->add(kinds[j].def, world);
      Random random(8);
      std::vector<PointPair> found;
      std::vector<double> apart, over, by_ode, by_fcl;
      for (int k = 0; k < 60; ++k) {
        const Isometry3d near = at_gap(*gaps, 0, 1, 2e-4, random), in = at_gap(*gaps, 0, 1, -5e-6, random);
        const auto query = [&](Detector& d, const Isometry3d& pose, double reach) {
          std::vector<double> t;
          for (int r = 0; r < 5; ++r)
            t.push_back(us([&] { d.query(0, Isometry3d::Identity(), 1, pose, reach, found); }));
          return median(t);
        };
        apart.push_back(query(*gaps, near, 1e-3));
        over.push_back(query(*gaps, in, 1e-3));
        by_ode.push_back(query(*ode, in, 0));
        if (fcl) by_fcl.push_back(query(*fcl, near, 1e-3));
      }
      const std::string name = std::string(kinds[i].name) + " - " + kinds[j].name;
      std::printf("%-22s %10.2f %10.2f %10.2f %10.2f\n", name.c_str(), median(apart), median(over), median(by_ode),
                  median(by_fcl));
      json["pairs_us"][name] = {
          {"gap", median(apart)}, {"overlap", median(over)}, {"ode", median(by_ode)}, {"fcl", median(by_fcl)}};
    }
}

void boxes(int count, int high, nlohmann::json& json) {
  WorldDef w = empty_world();
  add_floor(w);
  dSpaceID space = dHashSpaceCreate(nullptr);
  dCreatePlane(space, 0, 0, 1, 0);
  dWorldID ode = dWorldCreate();
  std::vector<BodyMotion> motions(1);
  std::vector<int> active;
  for (int i = 0; i < count; ++i) {
    const int tower = i / high;
    const Vector3d p(0.3 * (tower % 25), 0.3 * (tower / 25), 0.1 * (i % high + 0.5) - 1e-5 * (i % high + 1));
    active.push_back(add_box(w, 0.5, {0.1, 0.1, 0.1}, Isometry3d(Eigen::Translation3d(p))));
    BodyMotion& m = motions.emplace_back();
    m.position_m = m.centre_m = p;
    m.inverse_mass_1_kg = 2;
    const dGeomID geom = dCreateBox(space, 0.1, 0.1, 0.1);
    const dBodyID body = dBodyCreate(ode);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, p.x(), p.y(), p.z());
  }
  ContactFinder finder(w, Settings{});
  std::vector<Manifold> found;
  static dContactGeom raw[16];
  static int points;
  std::vector<double> ours, theirs;
  for (int i = 0; i < 200; ++i) {
    ours.push_back(us([&] { finder.find(motions, active, kStep, found); }));
    // As in a step: moved bodies have new bounding boxes.
    for (int g = 1; g < dSpaceGetNumGeoms(space); ++g) {
      const dBodyID body = dGeomGetBody(dSpaceGetGeom(space, g));
      if (!body) continue;
      const dReal* at = dBodyGetPosition(body);
      dBodySetPosition(body, at[0], at[1], at[2]);
    }
    points = 0;
    theirs.push_back(us([&] {
      dSpaceCollide(space, nullptr,
                    [](void*, dGeomID a, dGeomID b) { points += dCollide(a, b, 16, raw, sizeof(dContactGeom)); });
    }));
  }
  int contacts = 0;
  for (const Manifold& m : found) contacts += m.count;
  std::printf("%5d boxes %-18s %8d %10.0f %12d %10.0f\n", count, high > 1 ? "in towers of ten" : "apart", contacts,
              median(ours), points, median(theirs));
  json["boxes"].push_back(
      {{"count", count}, {"high", high}, {"ours_us", median(ours)}, {"ode_us", median(theirs)}});
  dSpaceDestroy(space);
  dWorldDestroy(ode);
}

}  // namespace

int main(int argc, char** argv) {
  tactus::sync::Arguments app("Cost of contact detection with gaps");
  std::string file;
  app.add_option("--json", file, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "gaps_bench", argc, argv);
  dInitODE2(0);
  nlohmann::json json;
  pairs(json);
  std::printf("\n%-30s %8s %10s %12s %10s\n", "all contacts, us", "points", "ours", "ODE points", "ODE");
  for (const int high : {1, 10})
    for (const int count : {10, 100, 500}) boxes(count, high, json);
  if (!file.empty()) std::ofstream(file) << json.dump(2) << '\n';
  dCloseODE();
}
