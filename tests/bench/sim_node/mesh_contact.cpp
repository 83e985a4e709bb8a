// Cost of mesh against mesh: two lumpy spheres at an exact gap, our layers compared with FCL's distance and ODE's trimesh collide,
// interleaved in one run.
//
//    bin/mesh_contact [--triangles 5120] [--gap_mm 0.3] [--tolerance_mm 1] [--poses 40] [--json FILE]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "sim_node/collision/detector.h"
#include "sim_node/collision/layers/patches.h"
#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;

namespace {

constexpr int kRounds = 9;  // rounds of every query at every pose
constexpr double kRadius_m = 0.1;

struct Row {
  std::string name;
  std::function<std::size_t(const Isometry3d&)> query;  // returns the number of contacts
  std::vector<double> all_us, per_pose_us;
  double found = 0;
};

double quantile(std::vector<double> x, double q) {
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())))];
}

double time_us(const std::function<std::size_t(const Isometry3d&)>& query, const Isometry3d& pose,
               std::size_t& found) {
  const auto begin = std::chrono::steady_clock::now();
  found = query(pose);
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
}

// Moves b straight towards a until the gap is exact, each time by a distance that cannot overshoot (conservative advancement).
Isometry3d approach(const ContactMesh& a, const ContactMesh& b, Random& random, double gap_m) {
  MeshContact contact;
  Isometry3d pose = random_pose(random, 1);
  const Eigen::Vector3d way = direction(random);
  pose.translation() = 3 * kRadius_m * way;
  for (int i = 0; i < 200; ++i) {
    const double d = contact.distance_m(a, Isometry3d::Identity(), b, pose, 10 * kRadius_m);
    if (std::abs(d - gap_m) < 1e-9) break;
    pose.translation() -= (d - gap_m) * way;
  }
  return pose;
}

}  // namespace

int main(int argc, char** argv) {
  int triangles = 5120, poses = 40;
  double gap_mm = 0.3, tolerance_mm = 1;
  std::string json;
  CLI::App app{"What mesh against mesh costs, ours beside FCL and ODE."};
  app.add_option("--triangles", triangles, "of each mesh: 20 times a power of four");
  app.add_option("--gap_mm", gap_mm);
  app.add_option("--tolerance_mm", tolerance_mm);
  app.add_option("--poses", poses);
  app.add_option("--json", json, "also write the figures there");
  CLI11_PARSE(app, argc, argv);
  int level = 0;
  while (20 << 2 * (level + 1) <= triangles) ++level;
  const double tolerance = 1e-3 * tolerance_mm;

  WorldDef world;
  for (const std::uint64_t seed : {1, 2}) {
    const Soup s = lumpy_sphere(level, kRadius_m, seed);
    world.meshes.push_back({s.vertices, {}, s.indices});
  }
  const auto shape = [](int mesh) {
    ShapeDef s;
    s.kind = ShapeKind::kMesh;
    s.mesh = mesh;
    return s;
  };
  const ContactMesh a(world.meshes[0].vertices, world.meshes[0].indices),
      b(world.meshes[1].vertices, world.meshes[1].indices);
  std::vector<Row> rows;
  const Isometry3d at = Isometry3d::Identity();
  const Reach reach{tolerance, tolerance / 5};

  struct Own {
    MeshContact contact;
    MeshContactResult result;
    Patches patches;
    std::vector<ContactPatch> made;
  };
  const auto add_own = [&](const std::string& name, const MeshContactOptions& options) {
    rows.push_back(
        {name,
         [&, own = std::make_shared<Own>(Own{MeshContact(options), {}, {}, {}})](const Isometry3d& pose) {
           own->contact.query(a, at, b, pose, reach, own->result);
           own->patches.make(own->result.pairs, tolerance, own->made);
           return own->result.pairs.size();
         },
         {},
         {}});
  };
  for (const Isa isa : {Isa::kBaseline, Isa::kAvx2, Isa::kAvx512})
    if (isa <= best_isa()) add_own("layers, complete, " + std::string(name_of(isa)), {.isa = isa});
  const std::size_t ours = rows.size() - 1;
  add_own("layers, itouch2005", {.mode = ContactMode::kItouch2005});
  auto boxes = std::make_shared<LeafPairs>();
  std::vector<std::pair<int, int>> leaves;
  rows.push_back({"layer 1 alone",
                  [&, boxes](const Isometry3d& pose) {
                    boxes->find(a.tree, at, b.tree, pose, tolerance, leaves);
                    return leaves.size();
                  },
                  {},
                  {}});
  std::vector<std::unique_ptr<Detector>> others;
  std::optional<std::size_t> fcl;
  for (const char* name : {"fcl", "ode"}) {
    std::unique_ptr<Detector> made = name == std::string("fcl") ? make_fcl_detector() : make_ode_detector();
    if (!made) continue;
    if (name == std::string("fcl")) fcl = rows.size();
    Detector* d = others.emplace_back(std::move(made)).get();
    d->add(shape(0), world);
    d->add(shape(1), world);
    rows.push_back({name == std::string("fcl") ? "FCL distance, OBBRSS" : "ODE trimesh collide",
                    [&, d, pairs = std::vector<PointPair>()](const Isometry3d& pose) mutable {
                      d->query(0, at, 1, pose, 1, pairs);
                      return pairs.size();
                    },
                    {},
                    {}});
  }

  Random random(42);
  for (int i = 0; i < poses; ++i) {
    const Isometry3d pose = approach(a, b, random, 1e-3 * gap_mm);
    std::vector<std::vector<double>> times(rows.size());
    std::size_t found = 0;
    for (Row& row : rows) time_us(row.query, pose, found);
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t r = 0; r < rows.size(); ++r) {
        times[r].push_back(time_us(rows[r].query, pose, found));
        if (round == 0) rows[r].found += static_cast<double>(found) / poses;
      }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      rows[r].per_pose_us.push_back(quantile(times[r], 0.5));
      rows[r].all_us.insert(rows[r].all_us.end(), times[r].begin(), times[r].end());
    }
  }

  std::printf(
      "%d triangles each, gap %.3g mm, tolerance %.3g mm, %d poses x %d rounds\n%-28s %10s %10s %10s %10s %10s\n",
      a.tree.empty() ? 0 : static_cast<int>(a.tree.triangles().size()), gap_mm, tolerance_mm, poses, kRounds, "us",
      "median", "p95 poses", "max poses", "p99 all", "found");
  nlohmann::json out;
  for (const Row& row : rows) {
    const double median = quantile(row.per_pose_us, 0.5), p99 = quantile(row.all_us, 0.99);
    std::printf("%-28s %10.1f %10.1f %10.1f %10.1f %10.1f\n", row.name.c_str(), median,
                quantile(row.per_pose_us, 0.95), quantile(row.per_pose_us, 1), p99, row.found);
    out[row.name] = {
        {"median_us", median}, {"p95_us", quantile(row.per_pose_us, 0.95)}, {"p99_us", p99}, {"found", row.found}};
  }
  const auto ratio = [&](std::size_t to) {
    return quantile(rows[ours].per_pose_us, 0.5) / quantile(rows[to].per_pose_us, 0.5);
  };
  if (fcl) std::printf("ours / FCL distance %.3f\n", ratio(*fcl));
  std::printf("ours / ODE collide  %.3f\n", ratio(rows.size() - 1));
  if (!json.empty()) std::ofstream(json) << out.dump(2) << "\n";
  return 0;
}
