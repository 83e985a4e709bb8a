// Cost of mesh against mesh: two lumpy spheres at an exact gap, our layers compared with FCL's distance and ODE's trimesh collide,
// interleaved in one run.
//
//    bin/mesh_contact [--triangles 5120] [--gap_mm 0.3] [--tolerance_mm 1] [--poses 40] [--json FILE]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "sim_node/collision/detector.h"
#include "sim_node/collision/layers/patches.h"
#include "sync/node/node_options.h"
#include "tests/sim_node/support/least_gap.h"
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
  Isometry3d pose = random_pose(random, 1);
  const Eigen::Vector3d away = direction(random);
  pose.translation() = 3 * kRadius_m * away;
  for (int i = 0; i < 200; ++i) {
    const double d = least_gap_m(a, b, pose);
    if (std::abs(d - gap_m) < 1e-9) break;
    pose.translation() -= (d - gap_m) * away;
  }
  return pose;
}

struct Options {
  int triangles = 5120, poses = 40;
  double gap_mm = 0.3, tolerance_mm = 1;
  std::string json;
  double tolerance_m() const { return 1e-3 * tolerance_mm; }
};

// A world with two lumpy spheres as meshes, each with at most the given number of triangles: 20 times a power of four.
WorldDef two_spheres(int triangles) {
  int level = 0;
  while (20 << 2 * (level + 1) <= triangles) ++level;
  WorldDef world;
  for (const std::uint64_t seed : {1, 2}) {
    const Soup s = lumpy_sphere(level, kRadius_m, seed);
    world.meshes.push_back({s.vertices, {}, s.indices});
  }
  return world;
}

ShapeDef mesh_shape(int mesh) {
  ShapeDef s;
  s.kind = ShapeKind::kMesh;
  s.mesh = mesh;
  return s;
}

// The compared queries between the two meshes of a world, which must outlive it. The rows refer to this object.
class Queries {
 public:
  Queries(const WorldDef& world, double tolerance_m)
      : a(world.meshes[0].vertices, world.meshes[0].indices),
        b(world.meshes[1].vertices, world.meshes[1].indices),
        tolerance_m_(tolerance_m),
        reach_{tolerance_m, tolerance_m / 5} {
    for (const Isa isa : {Isa::kBaseline, Isa::kAvx2, Isa::kAvx512})
      if (isa <= best_isa()) add_layers("layers, complete, " + std::string(name_of(isa)), {.isa = isa});
    complete_row = rows.size() - 1;
    add_layers("layers, itouch2005", {.mode = ContactMode::kItouch2005});
    add_first_layer();
    for (const char* name : {"fcl", "ode"}) add_detector(name, world);
  }
  Queries(const Queries&) = delete;
  Queries& operator=(const Queries&) = delete;

  const ContactMesh a, b;
  std::vector<Row> rows;
  std::size_t complete_row = 0;  // all layers, with the best instruction set
  std::optional<std::size_t> fcl_row;

 private:
  struct Layers {
    MeshContact contact;
    MeshContactResult result;
    Patches patches;
    std::vector<ContactPatch> made;
  };
  void add_layers(const std::string& name, const MeshContactOptions& options) {
    rows.push_back(
        {name,
         [this, own = std::make_shared<Layers>(Layers{MeshContact(options), {}, {}, {}})](const Isometry3d& pose) {
           own->contact.query(a, at_, b, pose, reach_, own->result);
           own->patches.make(own->result.pairs, tolerance_m_, own->made);
           return own->result.pairs.size();
         },
         {},
         {}});
  }
  void add_first_layer() {
    auto boxes = std::make_shared<LeafPairs>();
    rows.push_back({"layer 1 alone",
                    [this, boxes](const Isometry3d& pose) {
                      boxes->find(a.tree, at_, b.tree, pose, tolerance_m_, leaves_);
                      return leaves_.size();
                    },
                    {},
                    {}});
  }
  // FCL or ODE, when the build contains it.
  void add_detector(const std::string& name, const WorldDef& world) {
    std::unique_ptr<Detector> made = name == "fcl" ? make_fcl_detector() : make_ode_detector();
    if (!made) return;
    if (name == "fcl") fcl_row = rows.size();
    Detector* d = others_.emplace_back(std::move(made)).get();
    d->add(mesh_shape(0), world);
    d->add(mesh_shape(1), world);
    rows.push_back({name == "fcl" ? "FCL distance, OBBRSS" : "ODE trimesh collide",
                    [this, d, pairs = std::vector<PointPair>()](const Isometry3d& pose) mutable {
                      d->query(0, at_, 1, pose, 1, pairs);
                      return pairs.size();
                    },
                    {},
                    {}});
  }

  double tolerance_m_;
  Reach reach_;
  Isometry3d at_ = Isometry3d::Identity();
  std::vector<std::pair<int, int>> leaves_;
  std::vector<std::unique_ptr<Detector>> others_;
};

// Times all queries at random poses with the exact gap, interleaved.
void measure(Queries& queries, const Options& options) {
  std::vector<Row>& rows = queries.rows;
  Random random(42);
  for (int i = 0; i < options.poses; ++i) {
    const Isometry3d pose = approach(queries.a, queries.b, random, 1e-3 * options.gap_mm);
    std::vector<std::vector<double>> times(rows.size());
    std::size_t found = 0;
    for (Row& row : rows) time_us(row.query, pose, found);
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t r = 0; r < rows.size(); ++r) {
        times[r].push_back(time_us(rows[r].query, pose, found));
        if (round == 0) rows[r].found += static_cast<double>(found) / options.poses;
      }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      rows[r].per_pose_us.push_back(quantile(times[r], 0.5));
      rows[r].all_us.insert(rows[r].all_us.end(), times[r].begin(), times[r].end());
    }
  }
}

// Prints the table and the ratios to the other libraries, and writes the figures to a file when one is named.
void report(const Queries& queries, const Options& options) {
  const std::vector<Row>& rows = queries.rows;
  std::printf(
      "%d triangles each, gap %.3g mm, tolerance %.3g mm, %d poses x %d rounds\n%-28s %10s %10s %10s %10s %10s\n",
      queries.a.tree.empty() ? 0 : static_cast<int>(queries.a.tree.triangles().size()), options.gap_mm,
      options.tolerance_mm, options.poses, kRounds, "us", "median", "p95 poses", "max poses", "p99 all", "found");
  nlohmann::json out;
  for (const Row& row : rows) {
    const double median = quantile(row.per_pose_us, 0.5), p99 = quantile(row.all_us, 0.99);
    std::printf("%-28s %10.1f %10.1f %10.1f %10.1f %10.1f\n", row.name.c_str(), median,
                quantile(row.per_pose_us, 0.95), quantile(row.per_pose_us, 1), p99, row.found);
    out[row.name] = {
        {"median_us", median}, {"p95_us", quantile(row.per_pose_us, 0.95)}, {"p99_us", p99}, {"found", row.found}};
  }
  const auto ratio = [&](std::size_t to) {
    return quantile(rows[queries.complete_row].per_pose_us, 0.5) / quantile(rows[to].per_pose_us, 0.5);
  };
  if (queries.fcl_row) std::printf("ours / FCL distance %.3f\n", ratio(*queries.fcl_row));
  std::printf("ours / ODE collide  %.3f\n", ratio(rows.size() - 1));
  if (!options.json.empty()) std::ofstream(options.json) << out.dump(2) << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  tactus::sync::Arguments app{"Cost of mesh against mesh: our layers, FCL and ODE."};
  app.add_option("--triangles", options.triangles, "of each mesh: 20 times a power of four");
  app.add_option("--gap_mm", options.gap_mm);
  app.add_option("--tolerance_mm", options.tolerance_mm);
  app.add_option("--poses", options.poses);
  app.add_option("--json", options.json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "mesh_contact", argc, argv);
  const WorldDef world = two_spheres(options.triangles);
  Queries queries(world, options.tolerance_m());
  measure(queries, options);
  report(queries, options);
  return 0;
}
