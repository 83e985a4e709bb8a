#include "sim_node/collision/layers/mesh_contact.h"

#include "tests/sim_node/support/contact_check.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Case {
  std::string name;
  Soup a, b;
  double tolerance_m;
  double reach_m;  // maximum distance of the poses of b from a
};

// Meshes with a size of 0.1 m, as objects on a desk.
std::vector<Case> cases() {
  std::vector<Case> all;
  const double r = 0.1;
  all.push_back({"lumpy spheres", lumpy_sphere(2, r, 1), lumpy_sphere(2, r, 2), 2e-3, 2.1 * r});
  all.push_back({"combs", comb(4, r), comb(3, r), 3e-3, 0.6 * r});
  all.push_back({"plates", plate(r, r, 3, 4), plate(r, r, 5, 2), 4e-3, 0.3 * r});
  all.push_back({"slivers", slivers(60, r, 3), slivers(60, r, 4), 5e-3, r});
  all.push_back({"doubled and reversed", doubled_and_reversed(lumpy_sphere(1, r, 5)),
                 doubled_and_reversed(comb(2, r)), 3e-3, 1.3 * r});
  all.push_back(
      {"degenerate", with_degenerate(lumpy_sphere(1, r, 6)), with_degenerate(comb(2, r)), 3e-3, 1.3 * r});
  all.push_back({"T-junctions", t_junctions(r), t_junctions(1.3 * r), 4e-3, 0.3 * r});
  return all;
}

Isometry3d near_pose(const Case& c, Random& random) {
  Isometry3d pose = random_pose(random, 1);
  pose.translation() = uniform(random, 0.3, 1) * c.reach_m * direction(random);
  return pose;
}

ContactMesh mesh(const Soup& s) { return ContactMesh(s.vertices, s.indices); }

}  // namespace

TEST_CASE("Every pair of triangles within the tolerance is covered, without false or duplicate point pairs") {
  for (const Case& c : cases()) {
    Random random(7);
    const ContactMesh a = mesh(c.a), b = mesh(c.b);
    MeshContact contact;
    MeshContactResult found;
    int near = 0, apart = 0, pierced = 0;
    for (int i = 0; i < 24; ++i) {
      const Isometry3d pose_a = random_pose(random, 1), pose_b = pose_a * near_pose(c, random);
      contact.query(a, pose_a, b, pose_b, {c.tolerance_m, c.tolerance_m / 2}, found);
      INFO(c.name << ", pose " << i);
      const Placed pa(c.a, pose_a), pb(c.b, pose_b);
      const Truth truth = compare(pa, pb, c.tolerance_m, found);
      CHECK(truth.missed == 0);
      check_sound(pa, pb, c.tolerance_m, found);
      double least = 1e300;
      for (const PointPair& p : found.pairs) least = std::min(least, p.gap_m);
      if (truth.near > 0) CHECK(std::abs(least - truth.least) < 1e-9);
      near += truth.near > 0;
      apart += truth.near > 0 && truth.least > 1e-6;
      pierced += found.pierced;
      // The piercing alarm is never false.
      if (found.pierced) CHECK(truth.least < 1e-9);
    }
    INFO(c.name << ": " << near << " near, " << apart << " of them apart, " << pierced << " pierced");
    CHECK(near >= 6);
    CHECK(near > apart);
    CHECK(pierced > 0);
  }
}

TEST_CASE("Coincident meshes and opposite plates are covered") {
  for (const double gap : {0.0, 1e-12, 1e-4, 1e-3}) {
    const Soup lower = plate(0.1, 0.1, 4, 4), upper = t_junctions(0.08);
    Random random(3);
    const Isometry3d pose_a = random_pose(random, 1);
    const Isometry3d pose_b = pose_a * Eigen::Translation3d(0.01, 0, gap);
    MeshContact contact;
    MeshContactResult found;
    contact.query(mesh(lower), pose_a, mesh(upper), pose_b, {2e-3, 1e-3}, found);
    INFO("gap " << gap);
    const Placed pa(lower, pose_a), pb(upper, pose_b);
    const Truth truth = compare(pa, pb, 2e-3, found);
    CHECK(truth.near > 50);
    CHECK(truth.missed == 0);
    check_sound(pa, pb, 2e-3, found);
    CHECK(std::any_of(found.pairs.begin(), found.pairs.end(),
                      [](const PointPair& p) { return p.kind == ContactKind::kSurface; }));
  }
}

TEST_CASE("A mesh contact does not depend on mesh order, frame, winding or triangle order") {
  for (const Case& c : cases()) {
    Random random(11);
    int compared = 0;
    for (int i = 0; i < 12; ++i) {
      INFO(c.name << ", pose " << i);
      compared += check_invariant(c.a, c.b, near_pose(c, random), {c.tolerance_m, c.tolerance_m / 2}, random);
    }
    CHECK(compared > 50);
  }
}

TEST_CASE("Every instruction set gives a bit-identical contact") {
  const Case c = cases()[0];
  const ContactMesh a = mesh(lumpy_sphere(3, 0.1, 1)), b = mesh(lumpy_sphere(3, 0.1, 2));
  for (const Isa isa : {Isa::kAvx2, Isa::kAvx512}) {
    if (isa > best_isa()) {
      WARN("this processor has no " << name_of(isa) << ": that path is not tested here");
      continue;
    }
    Random random(5);
    MeshContact plain({.isa = Isa::kBaseline}), wide({.isa = isa});
    MeshContactResult x, y;
    std::size_t compared = 0;
    for (int i = 0; i < 40; ++i) {
      const Isometry3d pose = near_pose(c, random);
      plain.query(a, Isometry3d::Identity(), b, pose, {1e-3, 5e-4}, x);
      wide.query(a, Isometry3d::Identity(), b, pose, {1e-3, 5e-4}, y);
      REQUIRE(x.leaf_pairs == y.leaf_pairs);
      REQUIRE(x.pairs.size() == y.pairs.size());
      for (std::size_t k = 0; k < x.pairs.size(); ++k) REQUIRE(x.pairs[k].on_a_m == y.pairs[k].on_a_m);
      compared += x.pairs.size();
    }
    CHECK(compared > 100);
  }
}

TEST_CASE("An invalid mesh is rejected with one sentence") {
  const std::vector<Vector3d> v{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  using Indices = std::vector<int>;
  CHECK_THROWS_WITH(ObbTree(v, Indices{0, 1}), Catch::Contains("not a multiple of three"));
  CHECK_THROWS_WITH(ObbTree(v, Indices{0, 1, 3}), Catch::Contains("vertex 3"));
  CHECK_THROWS_WITH(ObbTree(v, Indices{0, 1, -1}), Catch::Contains("vertex -1"));
  const std::vector<Vector3d> bad{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}};
  CHECK_THROWS_WITH(ObbTree(bad, Indices{0, 1, 2}), Catch::Contains("not finite"));
  MeshContact contact;
  MeshContactResult found;
  contact.query(ContactMesh(v, Indices{}), Isometry3d::Identity(), ContactMesh(v, Indices{0, 1, 2}),
                Isometry3d::Identity(), {}, found);
  CHECK(found.pairs.empty());
}
