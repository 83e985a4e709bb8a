#include "sim_node/collision/layers/duplicates.h"

#include "tests/sim_node/support/contact_check.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

PointPair pair_at(const Vector3d& a, const Vector3d& b) {
  PointPair p;
  p.on_a_m = a, p.on_b_m = b;
  return p;
}

bool same_points(const std::vector<PointPair>& x, const std::vector<PointPair>& y) {
  return x.size() == y.size() &&
         std::equal(x.begin(), x.end(), y.begin(), [](const PointPair& p, const PointPair& q) {
           return p.on_a_m == q.on_a_m && p.on_b_m == q.on_b_m;
         });
}

}  // namespace

TEST_CASE("The hashed remover keeps the same pairs as brute force, also across cells") {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    std::vector<PointPair> pairs;
    for (int i = 0; i < 60; ++i) {
      // Positions on the borders of cells, around zero and far from it, where rounding moves a point to another cell.
      const double grid = 128 * kSamePosition_m * std::floor(uniform(random, -3, 3));
      const Vector3d at = (i % 2 ? grid : uniform(random, -1e-3, 1e-3)) * Vector3d::Ones() +
                          (i % 3 ? 0.0 : 40.0) * Vector3d::UnitX();
      for (int k = static_cast<int>(random() % 4); k >= 0; --k)
        pairs.push_back(
            pair_at(at + 0.4 * kSamePosition_m * direction(random), at + 0.4 * kSamePosition_m * direction(random)));
      // The same position on one surface only is not a duplicate.
      pairs.push_back(pair_at(at, at + 1e-4 * direction(random)));
    }
    for (std::size_t i = pairs.size(); i > 1; --i) std::swap(pairs[i - 1], pairs[random() % i]);
    std::vector<PointPair> hashed = pairs, brute = pairs;
    Duplicates remover;
    remover.remove_hashed(hashed);
    Duplicates::remove_brute_force(brute);
    CHECK(brute.size() < pairs.size());
    CHECK(brute.size() >= 60);
    CHECK(same_points(hashed, brute));
  }
}

TEST_CASE("All three removers agree on well-constructed meshes") {
  const Soup a = lumpy_sphere(2, 0.1, 1), b = box({0.1, 0.12, 0.08});
  const ContactMesh ma(a.vertices, a.indices), mb(b.vertices, b.indices);
  REQUIRE(ma.check.fault == "");
  REQUIRE(mb.check.fault == "");
  Random random(4);
  MeshContactResult hashed, brute, adjacent;
  std::size_t removed = 0;
  for (int i = 0; i < 30; ++i) {
    Isometry3d pose = random_pose(random, 1);
    pose.translation() = uniform(random, 0.12, 0.16) * direction(random);
    for (auto [remover, out] : {std::pair(DuplicateRemover::kHashed, &hashed),
                                {DuplicateRemover::kBruteForce, &brute},
                                {DuplicateRemover::kAdjacency, &adjacent}}) {
      MeshContact contact({.remover = remover});
      contact.check_supported(ma, mb);
      contact.query(ma, Isometry3d::Identity(), mb, pose, {2e-3, 1e-3}, *out);
    }
    CHECK(same_points(hashed.pairs, brute.pairs));
    CHECK(same_points(adjacent.pairs, brute.pairs));
    removed += brute.raw_pairs - brute.pairs.size();
  }
  CHECK(removed > 100);
}

TEST_CASE("The adjacency remover rejects a mesh with wrong adjacency with the reason") {
  const auto expect_rejection = [](const Soup& s, const std::string& why) {
    const Soup good = icosphere(1, 0.1);
    const ContactMesh bad(s.vertices, s.indices), fine(good.vertices, good.indices);
    CHECK_THROWS_WITH(MeshContact({.remover = DuplicateRemover::kAdjacency}).check_supported(fine, bad),
                      Catch::Contains(why) && Catch::Contains("choose the hashed remover"));
    CHECK_NOTHROW(MeshContact().check_supported(fine, bad));
    CHECK_NOTHROW(MeshContact({.remover = DuplicateRemover::kAdjacency}).check_supported(fine, fine));
  };
  expect_rejection(plate(1, 1, 2, 2), "on one side only");
  expect_rejection(doubled_and_reversed(icosphere(0, 1)), "on one side only");
  Soup twice = icosphere(0, 1);
  twice.indices.insert(twice.indices.end(), {twice.indices[0], twice.indices[1], twice.indices[2]});
  expect_rejection(twice, "twice in the same direction");
  Soup flat = icosphere(0, 1);
  flat.indices.insert(flat.indices.end(), {0, 0, 1});
  expect_rejection(flat, "uses a vertex twice");
  Soup line = icosphere(0, 1);
  line.vertices.insert(line.vertices.end(), {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  line.indices.insert(line.indices.end(), {12, 13, 14});
  expect_rejection(line, "no area");
  expect_rejection(Soup{}, "no triangles");
}
