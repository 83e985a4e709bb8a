// The search feature by feature, compared with the search over all pairs of triangles: random poses, every kind of
// mesh.
#include <algorithm>
#include <catch2/catch.hpp>

#include "sim_node/collision/detector.h"
#include "sim_node/collision/gaps/mesh_nearest.h"
#include "sim_node/collision/nearest_first.h"
#include "tests/sim_node/support/expected_pairs.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct FeatureScene {
  std::string name;
  Soup a, b;
  double min_m, max_m;  // distance of a from b
  double reach_m;
};

std::vector<FeatureScene> feature_scenes() {
  return {
      {"lumpy spheres", lumpy_sphere(2, 0.012, 1), lumpy_sphere(3, 0.05, 2), 0.058, 0.07, 0.009},
      {"a coarse sphere on a fine one", lumpy_sphere(1, 0.012, 7), lumpy_sphere(4, 0.03, 8), 0.038, 0.05, 0.006},
      {"a plate on a lumpy sphere", plate(0.03, 0.02, 6, 5), lumpy_sphere(3, 0.05, 5), 0.045, 0.055, 0.005},
      {"combs", comb(4, 0.06), comb(5, 0.06), 0.01, 0.04, 0.006},
      {"boxes", box({0.03, 0.02, 0.01}), box({0.05, 0.04, 0.03}), 0.02, 0.045, 0.008},
      {"doubled and reversed", doubled_and_reversed(lumpy_sphere(1, 0.03, 5)), doubled_and_reversed(comb(2, 0.1)),
       0.02, 0.07, 0.006},
      {"degenerate", with_degenerate(lumpy_sphere(1, 0.03, 6)), with_degenerate(comb(2, 0.1)), 0.02, 0.07, 0.006},
      {"slivers", slivers(30, 0.05, 3), slivers(40, 0.05, 4), 0.01, 0.05, 0.004}};
}

// Collects all pairs.
struct Everything : PairVisitor {
  bool is_redundant(const PointPair&) const override { return false; }
  bool visit(const PointPair& p) override {
    pairs.push_back(p);
    return true;
  }
  std::vector<PointPair> pairs;
};

// The selection of a tool: the nearest pair of each place and direction.
struct Selection : PairVisitor {
  explicit Selection(std::size_t most = 64) : most(most) {}
  static bool same(const PointPair& p, const PointPair& q) {
    return q.normal.dot(p.normal) > std::cos(0.1745) && (q.on_a_m - p.on_a_m).norm() < 0.002;
  }
  bool is_redundant(const PointPair& p) const override {
    return std::any_of(pairs.begin(), pairs.end(), [&](const PointPair& q) { return same(p, q); });
  }
  bool visit(const PointPair& p) override {
    pairs.push_back(p);
    return pairs.size() < most;
  }
  std::vector<PointPair> pairs;
  std::size_t most;
};

bool equal_pairs(const PointPair& p, const PointPair& q) {
  return (p.on_a_m - q.on_a_m).norm() < 1e-6 && (p.on_b_m - q.on_b_m).norm() < 1e-6;
}

int count_missing(const std::vector<PointPair>& wanted, const std::vector<PointPair>& found) {
  return static_cast<int>(std::count_if(wanted.begin(), wanted.end(), [&](const PointPair& p) {
    return std::none_of(found.begin(), found.end(), [&](const PointPair& q) { return equal_pairs(p, q); });
  }));
}

class Compared {
 public:
  explicit Compared(const FeatureScene& s) : scene(s), detector(make_gaps_detector({})), expected(s.a, s.b) {
    WorldDef world;
    world.meshes = {{s.a.vertices, {}, s.a.indices}, {s.b.vertices, {}, s.b.indices}};
    ShapeDef shape;
    shape.kind = ShapeKind::kMesh;
    for (shape.mesh = 0; shape.mesh < 2; ++shape.mesh) detector->add(shape, world);
    prepare_nearest_first(*detector, 0, 1);
  }

  // All contacts in the order of the search.
  std::vector<PointPair> exhaustive(const Isometry3d& at) {
    std::vector<PointPair> all;
    detector->query(0, at, 1, Isometry3d::Identity(), scene.reach_m, all);
    std::stable_sort(all.begin(), all.end(), gaps::comes_first);
    return all;
  }
  // Which of the triangles at a vertex represents it decides on overlaps in the exhaustive search, so only
  // separated surfaces are compared.
  static bool overlaps(const std::vector<PointPair>& all) {
    return std::any_of(all.begin(), all.end(), [](const PointPair& p) { return p.gap_m <= 0; });
  }
  void nearest(const Isometry3d& at, PairVisitor& visitor) {
    nearest_first(*detector, 0, at, 1, Isometry3d::Identity(), scene.reach_m, visitor, scratch);
  }

  const FeatureScene& scene;
  std::unique_ptr<Detector> detector;
  ExpectedPairs expected;
  std::vector<PointPair> scratch;
};

Isometry3d random_place(const FeatureScene& s, Random& random) {
  Isometry3d p = random_pose(random, 0.1);
  p.translation() = uniform(random, s.min_m, s.max_m) * direction(random);
  return p;
}

}  // namespace

TEST_CASE("The search by features finds every local minimum of the distance and every vertex over a face") {
  for (const FeatureScene& s : feature_scenes()) {
    Compared compared(s);
    Random random(29);
    int found = 0;
    for (int i = 0; i < 100; ++i) {
      const Isometry3d at = random_place(s, random);
      const std::vector<PointPair> all = compared.exhaustive(at);
      if (Compared::overlaps(all)) continue;
      Everything nearest;
      compared.nearest(at, nearest);
      std::vector<PointPair> expected;
      std::copy_if(all.begin(), all.end(), std::back_inserter(expected),
                   [&](const PointPair& p) { return compared.expected.expected(p, at); });
      INFO(s.name << ", pose " << i);
      CHECK(count_missing(expected, nearest.pairs) == 0);
      // Over a needle narrower than a micrometre, the exhaustive search keeps one of two pairs, which may be no
      // contact.
      if (s.name != "slivers") CHECK(count_missing(nearest.pairs, all) == 0);
      found += static_cast<int>(expected.size());
    }
    INFO(s.name);
    CHECK(found > 10);
  }
}

TEST_CASE("The search by features selects the planes of the exhaustive search on closed surfaces") {
  for (const FeatureScene& s : feature_scenes()) {
    if (s.name != "lumpy spheres" && s.name != "a coarse sphere on a fine one") continue;
    Compared compared(s);
    Random random(31);
    for (int i = 0; i < 200; ++i) {
      const Isometry3d at = random_place(s, random);
      const std::vector<PointPair> all = compared.exhaustive(at);
      if (Compared::overlaps(all)) continue;
      Selection exhaustive, nearest;
      for (const PointPair& p : all)
        if (!exhaustive.is_redundant(p) && !exhaustive.visit(p)) break;
      compared.nearest(at, nearest);
      INFO(s.name << ", pose " << i);
      CHECK(nearest.pairs.size() == exhaustive.pairs.size());
      CHECK(count_missing(exhaustive.pairs, nearest.pairs) == 0);
    }
  }
}

TEST_CASE("The steps of the search do not change the pairs and their order") {
  FeatureScene s{"far", lumpy_sphere(2, 0.012, 1), lumpy_sphere(3, 0.05, 2), 0, 0, 0.035};
  Compared compared(s);
  Random random(37);
  for (int i = 0; i < 10; ++i) {
    s.min_m = s.max_m = 0.075;
    const Isometry3d at = random_place(s, random);
    Selection exhaustive(1000), nearest(1000), few(8);
    for (const PointPair& p : compared.exhaustive(at))
      if (!exhaustive.is_redundant(p)) exhaustive.visit(p);
    compared.nearest(at, nearest);
    compared.nearest(at, few);
    CHECK(count_missing(exhaustive.pairs, nearest.pairs) == 0);
    CHECK(nearest.pairs.size() == exhaustive.pairs.size());
    REQUIRE(few.pairs.size() == 8);
    for (std::size_t k = 0; k < few.pairs.size(); ++k) CHECK(few.pairs[k].gap_m == nearest.pairs[k].gap_m);
  }
}
